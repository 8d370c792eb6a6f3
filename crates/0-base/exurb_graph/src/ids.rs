/// A node of a graph. Stays valid until the node is removed; never reused.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct NodeId(pub u32);

/// An edge of a graph. Stays valid until the edge is removed; never reused.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct EdgeId(pub u32);

/// An edge in one of its two directions: `2·edge` along its line, `2·edge + 1` against it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Dart(pub u32);

impl NodeId {
    /// As an index.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

impl EdgeId {
    /// As an index.
    pub fn index(self) -> usize {
        self.0 as usize
    }

    /// The dart along the edge's line.
    pub fn forward(self) -> Dart {
        Dart(self.0 * 2)
    }

    /// The dart against the edge's line.
    pub fn backward(self) -> Dart {
        Dart(self.0 * 2 + 1)
    }
}

impl Dart {
    /// As an index.
    pub fn index(self) -> usize {
        self.0 as usize
    }

    /// Its edge.
    pub fn edge(self) -> EdgeId {
        EdgeId(self.0 / 2)
    }

    /// Does it run along the edge's line?
    pub fn is_forward(self) -> bool {
        self.0.is_multiple_of(2)
    }

    /// The same edge in the other direction.
    pub fn twin(self) -> Self {
        Self(self.0 ^ 1)
    }
}
