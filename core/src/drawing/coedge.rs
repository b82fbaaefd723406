//! Co-edges: edges walked one way.

use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// An edge walked one way (paper, section 3).
///
/// In JSON a co-edge is a non-zero integer: `k` is edge number `k`, counted from 1, walked from
/// its first vertex to its second, `-k` the same edge walked backwards.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct CoEdge(u32);

impl CoEdge {
    /// The co-edge of edge `edge` (counted from 0), backwards if `reversed`.
    pub const fn new(edge: usize, reversed: bool) -> Self {
        Self((edge as u32) << 1 | reversed as u32)
    }

    /// The co-edge with the given dense index, `2 * edge + reversed`.
    pub const fn from_index(index: usize) -> Self {
        Self(index as u32)
    }

    /// Dense index `2 * edge + reversed`, for tables with one row a co-edge.
    pub const fn index(self) -> usize {
        self.0 as usize
    }

    /// Index of the edge, counted from 0.
    pub const fn edge(self) -> usize {
        (self.0 >> 1) as usize
    }

    /// Whether the edge is walked from its second vertex to its first.
    pub const fn is_reversed(self) -> bool {
        self.0 & 1 == 1
    }

    /// The same edge walked the other way.
    pub const fn mate(self) -> Self {
        Self(self.0 ^ 1)
    }

    /// The signed number used in files: edge number from 1, negative if reversed.
    pub const fn signed(self) -> i64 {
        let k = self.edge() as i64 + 1;
        if self.is_reversed() { -k } else { k }
    }

    /// The co-edge of a signed number; `None` for 0 and for numbers beyond `u32`.
    pub fn from_signed(k: i64) -> Option<Self> {
        let edge = k.unsigned_abs().checked_sub(1)?;
        (edge < u64::from(u32::MAX >> 1)).then(|| Self::new(edge as usize, k < 0))
    }
}

impl std::fmt::Debug for CoEdge {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}", self.signed())
    }
}

impl Serialize for CoEdge {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_i64(self.signed())
    }
}

impl<'de> Deserialize<'de> for CoEdge {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let k = i64::deserialize(deserializer)?;
        Self::from_signed(k)
            .ok_or_else(|| serde::de::Error::custom(format!("{k} is no co-edge number")))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn signed_numbers_round_trip() {
        for k in [1, -1, 7, -300] {
            let c = CoEdge::from_signed(k).unwrap();
            assert_eq!(c.signed(), k);
            assert_eq!(c.mate().signed(), -k);
            assert_eq!(CoEdge::from_index(c.index()), c);
        }
        assert_eq!(CoEdge::from_signed(0), None);
        assert_eq!(CoEdge::from_signed(i64::MIN), None);
    }
}
