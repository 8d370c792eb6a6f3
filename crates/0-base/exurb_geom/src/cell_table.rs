//! Lists by cell of a uniform grid, hashed into one flat table.
//!
//! No allocation per cell, and neither far outliers nor empty land cost memory. Cells that share a
//! slot only bring candidates that the caller's own test drops.

use crate::grid::LIMIT_MM;

/// Cells → numbers.
#[derive(Clone, Debug)]
pub struct CellTable {
    cell_mm: i64,
    mask: u64,
    /// Slot → range of `items`.
    starts: Vec<u32>,
    items: Vec<u32>,
}

impl CellTable {
    /// The table of items that `list` hands out as (slot, item). It is asked twice, to count and to
    /// fill, so that nothing but the table itself is ever held; it must say the same both times.
    pub fn new(cell_mm: i64, items: usize, list: impl Fn(&Self, &mut dyn FnMut(u32, u32))) -> Self {
        let slots = (items * 2).next_power_of_two().max(16);
        let mut table =
            Self { cell_mm, mask: slots as u64 - 1, starts: Vec::new(), items: Vec::new() };
        // The start of slot `s` is counted up at `s + 2` and moved to `s + 1` by filling.
        let mut starts = vec![0u32; slots + 2];
        list(&table, &mut |slot, _| starts[slot as usize + 2] += 1);
        for slot in 2..starts.len() {
            starts[slot] += starts[slot - 1];
        }
        let mut filled = vec![0; starts[slots + 1] as usize];
        list(&table, &mut |slot, item| {
            let next = &mut starts[slot as usize + 1];
            filled[*next as usize] = item;
            *next += 1;
        });
        (table.starts, table.items) = (starts, filled);
        table
    }

    /// Width of a cell.
    pub fn cell_mm(&self) -> i64 {
        self.cell_mm
    }

    /// Column or row of a coordinate.
    pub fn cell(&self, mm: i64) -> i64 {
        (mm + 2 * i64::from(LIMIT_MM)) / self.cell_mm
    }

    /// South or west border of a row or column.
    pub fn border_mm(&self, cell: i64) -> i64 {
        cell * self.cell_mm - 2 * i64::from(LIMIT_MM)
    }

    /// The slot of a cell.
    pub fn slot(&self, column: i64, row: i64) -> u32 {
        let mixed = (column as u64)
            .wrapping_mul(0x9E37_79B9_7F4A_7C15)
            .wrapping_add((row as u64).wrapping_mul(0xC2B2_AE3D_27D4_EB4F));
        (((mixed ^ (mixed >> 29)).wrapping_mul(0xBF58_476D_1CE4_E5B9) >> 32) & self.mask) as u32
    }

    /// What a slot lists.
    pub fn list(&self, slot: u32) -> &[u32] {
        let slot = slot as usize;
        &self.items[self.starts[slot] as usize..self.starts[slot + 1] as usize]
    }
}
