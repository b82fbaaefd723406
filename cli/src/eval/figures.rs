//! The figures of a whole data set, as JSON and as a table.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use faceformer::drawing::SurfaceKind;
use faceformer::identify::metrics::{Summary, median};
use serde::Serialize;

use super::compare::Compared;
use super::measure::{Corrupted, Measured};

/// What `eval --json` prints. Shares are 0 to 100, times are milliseconds.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct Figures {
    #[serde(flatten)]
    summary: Summary,
    #[serde(flatten)]
    solids: Option<SolidFigures>,
    #[serde(flatten)]
    corrupted: Option<CorruptedFigures>,
}

/// The further figures with `--corrupt`.
#[derive(Debug, Clone, Copy, Serialize)]
struct CorruptedFigures {
    /// Faces made wrong, over all drawings.
    corrupted: usize,
    /// Share of these that lifting names.
    named: f64,
    /// Share of drawings in which lifting names all of them.
    all_named: f64,
    /// Mean number of other faces that lifting names.
    accused: f64,
}

impl CorruptedFigures {
    fn of(measured: &[Measured]) -> Option<Self> {
        let all: Vec<Corrupted> = measured.iter().filter_map(|m| m.corrupted).collect();
        let sum = |f: fn(&Corrupted) -> usize| all.iter().map(f).sum::<usize>();
        let (corrupted, named) = (sum(|c| c.wrong), sum(|c| c.named));
        let count = all.len().max(1) as f64;
        let complete = all.iter().filter(|c| c.named == c.wrong).count();
        (!all.is_empty()).then(|| Self {
            corrupted,
            named: 100.0 * named as f64 / corrupted.max(1) as f64,
            all_named: 100.0 * complete as f64 / count,
            accused: sum(|c| c.accused) as f64 / count,
        })
    }
}

/// The further figures with `--solids`.
#[derive(Debug, Clone, Serialize)]
struct SolidFigures {
    /// Share of drawings whose every depth is right.
    lifted: f64,
    /// Share of drawings that gave a valid closed solid.
    valid: f64,
    /// Number of drawings whose solid is of an alternative, since the first reading has a fault.
    exchanged: usize,
    /// Share of the true right angles between neighbouring planes that the lift has within 1e-9, over
    /// the edges there of all drawings that could be lifted; `null` if there is no such edge.
    right_angles: Option<f64>,
    /// Number of these edges.
    right_angles_of: usize,
    /// Median time of lifting, over the drawings that could be lifted.
    lift_ms_median: f64,
    /// Median time of plan and solid, over the drawings that gave a valid one.
    solid_ms_median: f64,
    #[serde(flatten)]
    right: RightFigures,
    /// The same for each kind of surface, over the drawings whose truth has it.
    by_surface: BTreeMap<&'static str, KindFigures>,
}

/// How right solids are. Drawings without a solid count as wrong; those whose true solid cannot be
/// built to compare with are left out.
#[derive(Debug, Clone, Copy, Serialize)]
struct RightFigures {
    /// Share of drawings whose solid is within 1e-3 Chamfer distance of the true one.
    #[serde(rename = "chamfer_below_1e-3")]
    near: f64,
    /// Share of drawings whose solid has the true volume within 1%.
    volume_within_1pct: f64,
    /// Share of drawings whose solid has as many faces of each kind as the true one; of one kind,
    /// as many of that.
    faces_matched: f64,
    /// Share of drawings of which the solid, or that of one of the first three readings, is within
    /// 1e-3 of the true one.
    #[serde(rename = "chamfer_top3")]
    near_top3: f64,
    /// Number of drawings that are left out.
    no_truth: usize,
}

/// Figures of the drawings with a kind of surface.
#[derive(Debug, Clone, Copy, Serialize)]
struct KindFigures {
    /// Number of these drawings.
    drawings: usize,
    /// Share of them that gave a valid closed solid.
    valid: f64,
    #[serde(flatten)]
    right: RightFigures,
}

impl RightFigures {
    fn of(measured: &[&Measured], matched: impl Fn(&Compared) -> bool) -> Self {
        let no_truth = measured.iter().filter(|m| m.no_truth).count();
        let share = |right: &dyn Fn(&Compared) -> bool| {
            let all = measured.iter().filter_map(|m| m.compared.as_ref());
            let count = all.filter(|c| right(c)).count();
            100.0 * count as f64 / (measured.len() - no_truth).max(1) as f64
        };
        let top3 = measured.iter().filter(|m| m.near_top3).count();
        Self {
            near_top3: 100.0 * top3 as f64 / (measured.len() - no_truth).max(1) as f64,
            near: share(&|c| c.near),
            volume_within_1pct: share(&|c| c.volume),
            faces_matched: share(&matched),
            no_truth,
        }
    }
}

impl SolidFigures {
    fn of(measured: &[Measured]) -> Self {
        let all: Vec<&Measured> = measured.iter().collect();
        let share = |of: &[&Measured], right: fn(&Measured) -> bool| {
            let count = of.iter().filter(|m| right(m)).count();
            100.0 * count as f64 / of.len().max(1) as f64
        };
        let middle = |time: fn(&Measured) -> Option<f64>| {
            let mut times: Vec<f64> = measured.iter().filter_map(time).collect();
            times.sort_unstable_by(f64::total_cmp);
            median(&times)
        };
        let kinds = SurfaceKind::ALL.iter().enumerate().filter_map(|(k, kind)| {
            let of: Vec<&Measured> = measured.iter().filter(|m| m.kinds[k]).collect();
            let figures = KindFigures {
                drawings: of.len(),
                valid: share(&of, |m| m.valid),
                right: RightFigures::of(&of, |c| c.faces.of(*kind) == c.true_faces.of(*kind)),
            };
            (!of.is_empty()).then_some((kind.name(), figures))
        });
        let angles = || all.iter().filter_map(|m| m.right_angles);
        let wanted: usize = angles().map(|a| a.wanted).sum();
        let exact: usize = angles().map(|a| a.exact).sum();
        Self {
            right_angles: (wanted > 0).then(|| 100.0 * exact as f64 / wanted as f64),
            right_angles_of: wanted,
            lifted: share(&all, |m| m.lifted),
            valid: share(&all, |m| m.valid),
            exchanged: all.iter().filter(|m| m.exchanged).count(),
            lift_ms_median: middle(|m| m.lift_ms),
            solid_ms_median: middle(|m| m.solid_ms),
            right: RightFigures::of(&all, |c| c.faces == c.true_faces),
            by_surface: kinds.collect(),
        }
    }
}

impl Figures {
    /// The figures of the measured drawings.
    pub(crate) fn of(measured: &[Measured], solids: bool) -> Self {
        Self {
            summary: measured.iter().map(|m| &m.score).collect(),
            corrupted: CorruptedFigures::of(measured),
            solids: solids.then(|| SolidFigures::of(measured)),
        }
    }

    /// The figures as text, with the reasons of what was refused or failed.
    pub(crate) fn table(&self, measured: &[Measured]) -> String {
        let s = &self.summary;
        let mut text = format!(
            "{} drawings, {} faces, {} refused\n\n\
             faces   precision {:6.2}   recall {:6.2}   exact {:6.2}   exact in top 3 {:6.2}\n\
             types   paper's   {:6.2}   all six {:5.2}\n\
             loops   precision {:6.2}   recall {:6.2}   exact {:6.2}\n\
             time    median {:.3} ms   99th percentile {:.3} ms\n\
             calibration error   faces {:.4}   loops {:.4}\n",
            s.drawings,
            s.faces,
            s.refused,
            s.precision,
            s.recall,
            s.exact,
            s.exact_top3,
            s.type_rate,
            s.surface_rate,
            s.loop_precision,
            s.loop_recall,
            s.loops_exact,
            s.ms_median,
            s.ms_p99,
            s.calibration_error,
            s.loop_calibration_error,
        );
        // Writing to a string cannot fail.
        if let Some(s) = &self.solids {
            let r = &s.right;
            writeln!(
                text,
                "solids  lifted    {:6.2}   valid  {:6.2}   of alternatives {}\n\
                 right   Chamfer   {:6.2}   in top 3 {:6.2}   volume {:6.2}   faces {:6.2}   \
                 no truth {}\n\
                 angles  right     {}   of {}\n\
                 time    lift median {:.3} ms   solid median {:.3} ms",
                s.lifted,
                s.valid,
                s.exchanged,
                r.near,
                r.near_top3,
                r.volume_within_1pct,
                r.faces_matched,
                r.no_truth,
                s.right_angles
                    .map_or_else(|| "     -".to_owned(), |a| format!("{a:6.2}")),
                s.right_angles_of,
                s.lift_ms_median,
                s.solid_ms_median
            )
            .ok();
            for (kind, k) in &s.by_surface {
                let r = &k.right;
                writeln!(
                    text,
                    "  {kind:8} {:5} drawings   valid {:6.2}   Chamfer {:6.2}   volume {:6.2}   \
                     faces {:6.2}   no truth {}",
                    k.drawings, k.valid, r.near, r.volume_within_1pct, r.faces_matched, r.no_truth
                )
                .ok();
            }
        }
        if let Some(c) = &self.corrupted {
            writeln!(
                text,
                "wrong   faces {}   named {:6.2}   all named {:6.2}   others named {:.2} a drawing",
                c.corrupted, c.named, c.all_named, c.accused
            )
            .ok();
        }
        let reasons = reasons(measured);
        if !reasons.is_empty() {
            text.push_str("\nrefused or failed (numbers masked)\n");
        }
        for ((stage, message), count) in reasons {
            writeln!(text, "{count:5}  {stage:8}  {message}").ok();
        }
        text
    }
}

/// How often each reason came up, the most frequent first.
fn reasons(measured: &[Measured]) -> Vec<((&'static str, String), usize)> {
    let mut counts = BTreeMap::new();
    for failed in measured.iter().flat_map(|m| &m.failed) {
        *counts
            .entry((failed.stage, mask(&failed.message)))
            .or_insert(0) += 1;
    }
    let mut counts: Vec<_> = counts.into_iter().collect();
    counts.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
    counts
}

/// A message without its numbers, so that equal reasons are counted together; lists of numbers
/// count as one.
fn mask(message: &str) -> String {
    let mut out = String::new();
    let mut number = false;
    for c in message.chars() {
        let part = c.is_ascii_digit() || (number && matches!(c, '.' | '-' | '+' | 'e'));
        if part && !number {
            out.push('#');
        } else if !part {
            out.push(c);
        }
        number = part;
    }
    while out.contains("#, #") {
        out = out.replace("#, #", "#");
    }
    out
}

#[cfg(test)]
mod tests {
    use faceformer::identify::metrics::DrawingScore;
    use faceformer_occt::FaceCounts;

    use super::*;
    use crate::eval::measure::Failed;
    use crate::eval::right_angles::RightAngles;

    fn one(lifted: bool, messages: &[&str]) -> Measured {
        Measured {
            score: DrawingScore {
                faces: 4,
                predicted: 4,
                matched: 2,
                ms: 1.0,
                ..DrawingScore::default()
            },
            lifted,
            valid: false,
            lift_ms: lifted.then_some(3.0),
            solid_ms: None,
            corrupted: None,
            compared: None,
            right_angles: None,
            exchanged: false,
            near_top3: false,
            no_truth: false,
            kinds: [true, false, false, true, false, false],
            failed: messages
                .iter()
                .map(|message| Failed {
                    id: "a".to_owned(),
                    stage: "lift",
                    message: (*message).to_owned(),
                })
                .collect(),
        }
    }

    #[test]
    fn json_is_one_flat_object() {
        let measured = [one(true, &[]), one(false, &[])];
        let value = serde_json::to_value(Figures::of(&measured, true)).unwrap();
        for (key, expected) in [
            ("drawings", 2.0),
            ("faces", 8.0),
            ("precision", 50.0),
            ("recall", 50.0),
            ("exact", 0.0),
            ("lifted", 50.0),
            ("valid", 0.0),
            ("lift_ms_median", 3.0),
            ("solid_ms_median", 0.0),
        ] {
            assert_eq!(value[key].as_f64(), Some(expected), "{key}");
        }
        let without = serde_json::to_value(Figures::of(&measured, false)).unwrap();
        assert!(without.get("lifted").is_none());
    }

    #[test]
    fn solids_are_right_overall_and_by_kind() {
        let right = |sphere| Compared {
            near: true,
            volume: false,
            faces: FaceCounts {
                plane: 4,
                sphere,
                ..FaceCounts::default()
            },
            true_faces: FaceCounts {
                plane: 4,
                sphere: 1,
                ..FaceCounts::default()
            },
            chamfer: 1e-5,
        };
        let mut all = [(); 4].map(|()| one(true, &[]));
        all[0].compared = Some(right(1));
        all[1].compared = Some(right(2));
        all[2].no_truth = true;
        let value = serde_json::to_value(Figures::of(&all, true)).unwrap();
        // Of three: the one without a truth is left out, the one without a solid is not.
        let share = |value: &serde_json::Value, key: &str| value[key].as_f64().unwrap();
        assert!((share(&value, "chamfer_below_1e-3") - 200.0 / 3.0).abs() < 1e-9);
        assert!((share(&value, "faces_matched") - 100.0 / 3.0).abs() < 1e-9);
        assert_eq!(share(&value, "volume_within_1pct"), 0.0);
        assert_eq!(share(&value, "no_truth"), 1.0);
        let kinds = &value["by_surface"];
        assert!((share(&kinds["plane"], "faces_matched") - 200.0 / 3.0).abs() < 1e-9);
        assert!((share(&kinds["sphere"], "faces_matched") - 100.0 / 3.0).abs() < 1e-9);
        assert!(kinds.get("torus").is_none());
        let table = Figures::of(&all, true).table(&all);
        assert!(table.contains("sphere"), "{table}");
    }

    #[test]
    fn right_angles_are_counted_over_the_drawings_that_lift() {
        let mut all = [(); 3].map(|()| one(true, &[]));
        let none = serde_json::to_value(Figures::of(&all, true)).unwrap();
        assert!(none["right_angles"].is_null());
        all[0].right_angles = Some(RightAngles {
            wanted: 12,
            exact: 12,
        });
        all[1].right_angles = Some(RightAngles {
            wanted: 4,
            exact: 0,
        });
        let value = serde_json::to_value(Figures::of(&all, true)).unwrap();
        assert_eq!(value["right_angles"].as_f64(), Some(75.0));
        assert_eq!(value["right_angles_of"].as_u64(), Some(16));
    }

    #[test]
    fn reasons_are_counted_without_their_numbers() {
        let measured = [
            one(false, &["vertices [1, 2, 30] open by 1.5e-3; fix"]),
            one(false, &["vertices [7] open by 2e+4; fix", "other"]),
        ];
        let counted = reasons(&measured);
        assert_eq!(counted[0].0.1, "vertices [#] open by #; fix");
        assert_eq!((counted[0].1, counted[1].1), (2, 1));
        let table = Figures::of(&measured, true).table(&measured);
        assert!(table.contains("2  lift"), "{table}");
    }
}
