//! Writing drawings in the interchange format.

use serde::ser::{Serialize, SerializeMap, Serializer};

use super::super::{Curve2, Drawing, Edge};

impl Drawing {
    /// The drawing in the interchange format. Every number is written so that reading it gives the
    /// same double. Each edge also carries what it was recognised as, in the key `curve`, which
    /// readers ignore.
    pub fn to_json(&self) -> String {
        serde_json::to_string(self).expect("drawings have string keys only")
    }
}

impl Serialize for Drawing {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(None)?;
        map.serialize_entry("id", &self.id)?;
        map.serialize_entry("source", &self.source)?;
        map.serialize_entry("projection", &self.projection)?;
        map.serialize_entry("vertices", &self.vertices)?;
        map.serialize_entry("edges", &self.edges)?;
        if let Some(truth) = &self.truth {
            map.serialize_entry("truth", truth)?;
        }
        map.end()
    }
}

impl Serialize for Edge {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(3))?;
        map.serialize_entry("v", &self.v)?;
        map.serialize_entry("points", &self.points)?;
        map.serialize_entry::<_, Curve2>("curve", &self.curve)?;
        map.end()
    }
}
