//! Streaming JSON reader of all input forms.
//!
//! It is written by hand on serde's seeds for two reasons: limits must stop the reading itself (a
//! file with a million edges is refused after the first few thousand), and an error must name the
//! edge it stands in.

use std::cell::{Cell, RefCell};
use std::fmt;

use glam::DVec2;
use serde::de::{self, DeserializeSeed, Deserializer, IgnoredAny, MapAccess, SeqAccess, Visitor};

use super::super::{DrawingError, Limits, Projection, Truth};
use super::release::Release;

/// An edge as a file lists it.
#[derive(Debug, Default)]
pub(in super::super) struct RawEdge {
    pub(in super::super) name: Option<String>,
    pub(in super::super) v: Option<[usize; 2]>,
    pub(in super::super) points: Vec<DVec2>,
}

/// Everything that any of the input forms may hold.
#[derive(Debug, Default)]
pub(in super::super) struct Raw {
    pub(in super::super) id: String,
    pub(in super::super) source: String,
    pub(in super::super) projection: Projection,
    pub(in super::super) vertices: Option<Vec<DVec2>>,
    pub(in super::super) edges: Vec<RawEdge>,
    pub(in super::super) truth: Option<Truth>,
    pub(in super::super) release: Release,
}

impl Raw {
    /// Whether the file is of the Faceformer release.
    pub(super) fn is_release(&self) -> bool {
        self.release.pairings.is_some()
    }

    /// What messages call the edges: their names, else their numbers from 1.
    pub(in super::super) fn labels(&self) -> Vec<String> {
        let label = |(i, e): (usize, &RawEdge)| match &e.name {
            Some(name) if !name.is_empty() => name.clone(),
            _ => format!("edge {}", i + 1),
        };
        self.edges.iter().enumerate().map(label).collect()
    }
}

/// Parses a text of any form; shapes and limits are checked, references are not.
pub(super) fn parse(text: &str, limits: &Limits) -> Result<Raw, DrawingError> {
    let state = State {
        limits,
        refusal: RefCell::new(None),
        place: Cell::new(Place::Top),
        points: Cell::new(0),
    };
    let mut json = serde_json::Deserializer::from_str(text);
    let result = DrawingSeed(&state)
        .deserialize(&mut json)
        .and_then(|raw| json.end().map(|()| raw));
    result.map_err(|e| state.explain(text, &e))
}

/// Where the reader stands, for messages.
#[derive(Clone, Copy)]
enum Place {
    Top,
    Edge(usize),
    Vertex(usize),
    Truth,
}

struct State<'a> {
    limits: &'a Limits,
    /// An error that says more than serde's text; it goes before it.
    refusal: RefCell<Option<DrawingError>>,
    place: Cell<Place>,
    points: Cell<usize>,
}

impl State<'_> {
    fn refuse<E: de::Error>(&self, error: DrawingError) -> E {
        let e = E::custom(&error);
        self.refusal.replace(Some(error));
        e
    }

    fn not_finite(&self) -> DrawingError {
        match self.place.get() {
            Place::Edge(edge) => DrawingError::NotFinite { edge: edge + 1 },
            Place::Vertex(vertex) => DrawingError::VertexNotFinite { vertex },
            Place::Truth => DrawingError::Truth("a number in it is not finite".into()),
            Place::Top => DrawingError::Format("a number in it is not finite".into()),
        }
    }

    fn explain(&self, text: &str, error: &serde_json::Error) -> DrawingError {
        if let Some(refusal) = self.refusal.take() {
            return refusal;
        }
        // Python writes NaN and Infinity, which JSON has not; 1e999 is beyond a double.
        if token(text, error).is_some_and(|t| t.parse::<f64>().is_ok_and(|x| !x.is_finite())) {
            return self.not_finite();
        }
        match self.place.get() {
            Place::Top => DrawingError::Format(error.to_string()),
            Place::Edge(edge) => DrawingError::Format(format!("edge {}: {error}", edge + 1)),
            Place::Vertex(vertex) => DrawingError::Format(format!("vertex {vertex}: {error}")),
            Place::Truth => DrawingError::Truth(error.to_string()),
        }
    }
}

/// The number-like word at the place where the JSON reader stopped.
fn token<'t>(text: &'t str, error: &serde_json::Error) -> Option<&'t str> {
    let line = text.split('\n').nth(error.line().checked_sub(1)?)?;
    let at = error.column().min(line.len());
    let inside = |b: &u8| b.is_ascii_alphanumeric() || b"+-.".contains(b);
    let bytes = line.as_bytes();
    let start = at - bytes[..at].iter().rev().take_while(|b| inside(b)).count();
    let end = at + bytes[at..].iter().take_while(|b| inside(b)).count();
    line.get(start..end)
}

struct DrawingSeed<'a, 'l>(&'a State<'l>);

impl<'de> DeserializeSeed<'de> for DrawingSeed<'_, '_> {
    type Value = Raw;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<Raw, D::Error> {
        deserializer.deserialize_map(self)
    }
}

impl<'de> Visitor<'de> for DrawingSeed<'_, '_> {
    type Value = Raw;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("an object with edges")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Raw, A::Error> {
        let state = self.0;
        let mut raw = Raw::default();
        let (mut edges, mut truth) = (None, None);
        while let Some(key) = map.next_key::<String>()? {
            match key.as_str() {
                "id" => raw.id = map.next_value()?,
                "source" => raw.source = map.next_value()?,
                "projection" => raw.projection = map.next_value()?,
                "vertices" => {
                    let vertices = map.next_value_seed(ListSeed {
                        state,
                        what: "vertices",
                        limit: state.limits.edges.saturating_mul(2),
                        place: Some(Place::Vertex),
                        item: PointSeed(state),
                    })?;
                    once(&mut raw.vertices, vertices, "vertices")?;
                }
                "edges" => {
                    let list = map.next_value_seed(ListSeed {
                        state,
                        what: "edges",
                        limit: state.limits.edges,
                        place: Some(Place::Edge),
                        item: EdgeSeed(state),
                    })?;
                    once(&mut edges, list, "edges")?;
                }
                "truth" => {
                    state.place.set(Place::Truth);
                    let value = map.next_value()?;
                    once(&mut truth, value, "truth")?;
                }
                "pairings" => {
                    let value = map.next_value()?;
                    once(&mut raw.release.pairings, value, "pairings")?;
                }
                "faces_indices" => {
                    state.place.set(Place::Truth);
                    let value = map.next_value()?;
                    once(&mut raw.release.faces, value, "faces_indices")?;
                }
                "edges3d" => {
                    state.place.set(Place::Truth);
                    raw.release.edges3d = map.next_value()?;
                }
                "dominant_directions" => {
                    state.place.set(Place::Truth);
                    raw.release.directions = map.next_value()?;
                }
                _ => {
                    map.next_value::<IgnoredAny>()?;
                }
            }
            state.place.set(Place::Top);
        }
        raw.truth = truth.flatten();
        raw.edges = edges.ok_or_else(|| de::Error::missing_field("edges"))?;
        Ok(raw)
    }
}

/// Fills a field that may be there once only.
fn once<T, E: de::Error>(field: &mut Option<T>, value: T, name: &'static str) -> Result<(), E> {
    match field.replace(value) {
        Some(_) => Err(E::duplicate_field(name)),
        None => Ok(()),
    }
}

/// A list of items, at most `limit` of them.
struct ListSeed<'a, 'l, S> {
    state: &'a State<'l>,
    what: &'static str,
    limit: usize,
    place: Option<fn(usize) -> Place>,
    item: S,
}

impl<'de, S: DeserializeSeed<'de> + Copy> DeserializeSeed<'de> for ListSeed<'_, '_, S> {
    type Value = Vec<S::Value>;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<Self::Value, D::Error> {
        deserializer.deserialize_seq(self)
    }
}

impl<'de, S: DeserializeSeed<'de> + Copy> Visitor<'de> for ListSeed<'_, '_, S> {
    type Value = Vec<S::Value>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "a list of {}", self.what)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Self::Value, A::Error> {
        let mut items = Vec::new();
        loop {
            if let Some(place) = self.place {
                self.state.place.set(place(items.len()));
            }
            let Some(item) = seq.next_element_seed(self.item)? else {
                return Ok(items);
            };
            items.push(item);
            if items.len() > self.limit {
                return Err(self.state.refuse(DrawingError::TooLarge {
                    what: self.what,
                    found: items.len(),
                    limit: self.limit,
                }));
            }
        }
    }
}

#[derive(Clone, Copy)]
struct EdgeSeed<'a, 'l>(&'a State<'l>);

impl<'a, 'l> EdgeSeed<'a, 'l> {
    fn points(self) -> ListSeed<'a, 'l, PointSeed<'a, 'l>> {
        ListSeed {
            state: self.0,
            what: "points in one edge",
            limit: self.0.limits.points,
            place: None,
            item: PointSeed(self.0),
        }
    }

    fn count<E: de::Error>(self, points: &[DVec2]) -> Result<(), E> {
        let state = self.0;
        let total = state.points.get() + points.len();
        state.points.set(total);
        if total > state.limits.total_points {
            return Err(state.refuse(DrawingError::TooLarge {
                what: "points",
                found: total,
                limit: state.limits.total_points,
            }));
        }
        Ok(())
    }
}

impl<'de> DeserializeSeed<'de> for EdgeSeed<'_, '_> {
    type Value = RawEdge;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<RawEdge, D::Error> {
        deserializer.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for EdgeSeed<'_, '_> {
    type Value = RawEdge;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("an edge: an object with points, or a list of points")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<RawEdge, A::Error> {
        let points = self.points().visit_seq(seq)?;
        self.count(&points)?;
        Ok(RawEdge {
            points,
            ..RawEdge::default()
        })
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<RawEdge, A::Error> {
        let mut edge = RawEdge::default();
        let mut points = None;
        while let Some(key) = map.next_key::<String>()? {
            match key.as_str() {
                "name" => edge.name = map.next_value()?,
                "v" => edge.v = Some(map.next_value()?),
                "points" => {
                    let list = map.next_value_seed(self.points())?;
                    self.count(&list)?;
                    once(&mut points, list, "points")?;
                }
                _ => {
                    map.next_value::<IgnoredAny>()?;
                }
            }
        }
        edge.points = points.ok_or_else(|| de::Error::missing_field("points"))?;
        Ok(edge)
    }
}

/// A point `[x, y]`; null stands for NaN, as many JSON writers do it, and is refused by name.
#[derive(Clone, Copy)]
struct PointSeed<'a, 'l>(&'a State<'l>);

impl<'de> DeserializeSeed<'de> for PointSeed<'_, '_> {
    type Value = DVec2;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<DVec2, D::Error> {
        deserializer.deserialize_seq(self)
    }
}

impl<'de> Visitor<'de> for PointSeed<'_, '_> {
    type Value = DVec2;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a point [x, y]")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<DVec2, A::Error> {
        let mut xy = [0.0; 2];
        for (i, value) in xy.iter_mut().enumerate() {
            *value = match seq.next_element::<Option<f64>>()? {
                Some(Some(x)) if x.is_finite() => x,
                Some(_) => return Err(self.0.refuse(self.0.not_finite())),
                None => return Err(de::Error::invalid_length(i, &self)),
            };
        }
        if seq.next_element::<IgnoredAny>()?.is_some() {
            return Err(de::Error::invalid_length(3, &self));
        }
        Ok(DVec2::from(xy))
    }
}
