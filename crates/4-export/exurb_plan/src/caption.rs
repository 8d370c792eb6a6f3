//! Scale bar, attribution and legend, on plates in the corners.

use crate::display::{Mark, Paint, Pen, Px, Shape};
use crate::font;
use crate::map::Map;

/// A corner's plate grows with what is put on it.
struct Sizes {
    letter_px: f32,
    pad_px: f32,
    line_px: f32,
}

impl Sizes {
    fn of(map: &Map) -> Self {
        let letter_px = (map.view.width_px as f32 / 165.0).clamp(5.0, 40.0);
        Self { letter_px, pad_px: letter_px * 0.9, line_px: letter_px * 1.9 }
    }
}

pub fn draw(map: &Map) -> Vec<Mark> {
    let mut marks = scale_and_attribution(map);
    marks.extend(legend(map));
    marks
}

fn scale_and_attribution(map: &Map) -> Vec<Mark> {
    let s = Sizes::of(map);
    let (page_w, page_h) = (map.view.width_px as f32, map.view.height_px as f32);
    let (bar_m, bar_label) = bar_length(map.view.bounds.size().x * 0.16);
    let bar_px = map.view.px(bar_m);
    let bar_width = bar_px + s.letter_px * 0.8 + font::width(&bar_label, s.letter_px);
    let lines = wrapped(&map.city.metadata.attribution, s.letter_px, page_w * 0.6);
    let text_width = lines.iter().map(|l| font::width(l, s.letter_px)).fold(bar_width, f32::max);
    let (w, h) = (text_width + 2.0 * s.pad_px, s.line_px * (lines.len() + 1) as f32 + s.pad_px);
    let (left, top) = (page_w - w, page_h - h);
    let right = page_w - s.pad_px;

    let mut marks = vec![plate(map, [left, top], [w, h])];
    let base = top + s.line_px * 0.5 + s.pad_px * 0.5 + s.letter_px * 0.5;
    let x = right - bar_width;
    marks.extend(bar(map, [x, base], bar_px, s.letter_px));
    marks.push(text(map, [x + bar_px + s.letter_px * 0.8, base], s.letter_px, bar_label));
    for (line, row) in lines.into_iter().zip(1..) {
        let at = [right - font::width(&line, s.letter_px), base + s.line_px * row as f32];
        marks.push(text(map, at, s.letter_px, line));
    }
    marks
}

/// Two fields, dark and light, in a frame.
fn bar(map: &Map, at: Px, length_px: f32, letter_px: f32) -> Vec<Mark> {
    let height = letter_px * 0.5;
    let field = |from: f32, to: f32, paint| {
        let (y0, y1) = (at[1] - letter_px * 0.25 - height, at[1] - letter_px * 0.25);
        let (x0, x1) = (at[0] + length_px * from, at[0] + length_px * to);
        Mark::new(Shape::Area(vec![vec![[x0, y0], [x1, y0], [x1, y1], [x0, y1]]]), paint)
    };
    let frame = Pen::solid(map.sheet.text, letter_px * 0.1);
    vec![
        field(0.0, 0.5, Paint::both(map.sheet.text, frame)),
        field(0.5, 1.0, Paint::both(map.sheet.plate, frame)),
    ]
}

/// The longest of 1, 2, 5 · 10ⁿ metres up to `most_m`, and its name.
fn bar_length(most_m: f64) -> (f64, String) {
    let mut best = 1.0;
    let mut power = 1.0;
    while power <= most_m {
        for digit in [1.0, 2.0, 5.0] {
            if digit * power <= most_m {
                best = digit * power;
            }
        }
        power *= 10.0;
    }
    let label = if best >= 1000.0 { format!("{} km", best / 1000.0) } else { format!("{best} m") };
    (best, label)
}

fn legend(map: &Map) -> Vec<Mark> {
    let entries = map.key.legend(map.city);
    if entries.is_empty() {
        return Vec::new();
    }
    let s = Sizes::of(map);
    let widest = entries.iter().map(|e| font::width(&e.label, s.letter_px)).fold(0.0, f32::max);
    let swatch = s.letter_px * 2.0;
    let size = [widest + swatch + 3.0 * s.pad_px, s.line_px * entries.len() as f32 + s.pad_px];
    let mut marks = vec![plate(map, [0.0, 0.0], size)];
    for (entry, row) in entries.into_iter().zip(0..) {
        let base = s.pad_px + s.letter_px + s.line_px * row as f32;
        let (x0, x1) = (s.pad_px, s.pad_px + swatch);
        let (y0, y1) = (base - s.letter_px, base);
        let corners = vec![[x0, y0], [x1, y0], [x1, y1], [x0, y1]];
        marks.push(Mark::new(Shape::Area(vec![corners]), Paint::fill(entry.color)));
        marks.push(text(map, [x1 + s.pad_px, base], s.letter_px, entry.label));
    }
    marks
}

fn plate(map: &Map, at: Px, size: [f32; 2]) -> Mark {
    let [x, y] = at;
    let [w, h] = size;
    let corners = vec![[x, y], [x + w, y], [x + w, y + h], [x, y + h]];
    Mark::new(Shape::Area(vec![corners]), Paint::fill(map.sheet.plate))
}

fn text(map: &Map, at: Px, height_px: f32, text: String) -> Mark {
    let pen = Pen::solid(map.sheet.text, height_px * 0.13);
    Mark::new(Shape::Text { at, height_px, text }, Paint::pen(pen))
}

/// The attributions in as few lines as fit.
fn wrapped(attributions: &[String], letter_px: f32, most_px: f32) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in attributions.join("; ").split_whitespace() {
        match lines.last_mut() {
            Some(line) if font::width(&format!("{line} {word}"), letter_px) <= most_px => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines.truncate(6);
    lines
}
