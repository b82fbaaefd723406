//! Measures planning and building on a data set with truth: which share of its drawings gives a
//! valid solid, how long it takes, and why the others fail.
//!
//! ```text
//! cargo run --release -p faceformer-occt --example measure -- DATA.jsonl.zst [--all] [--lift] [--list] [--each] [--dump DIR]
//! ```
//! The depths are the true ones, or with `--lift` those that lifting finds for the true faces. Only
//! drawings of planes and cylinders count, unless `--all`. `--list` names the failures, `--each`
//! prints one JSON line a drawing, `--dump` writes the plans and partial shells of failures.

#[path = "../tests/common/truth.rs"]
mod truth;

use std::collections::BTreeMap;
use std::path::Path;
use std::time::Instant;

use faceformer::Progress;
use faceformer::drawing::{Drawing, SurfaceKind};
use faceformer::identify::from_truth;
use faceformer::lift::{LiftOptions, lift};
use faceformer::plan::{PlanOptions, plan};
use faceformer_occt::{SolidReport, build};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let flag = |name: &str| arguments.iter().any(|a| a == name);
    let dump = arguments.iter().position(|a| a == "--dump");
    let dump = dump.and_then(|i| arguments.get(i + 1));
    let data = arguments.first().ok_or("name a data set")?;
    let mut failures: BTreeMap<String, Vec<String>> = BTreeMap::new();
    let (mut count, mut valid, mut filled) = (0, 0, 0);
    let (mut plan_ms, mut build_ms) = (Vec::new(), Vec::new());
    let mut largest_tolerance = 0f64;
    for drawing in faceformer::drawing::dataset::Drawings::open(data)? {
        let drawing = drawing?;
        if !flag("--all") && !is_simple(&drawing) {
            continue;
        }
        count += 1;
        let result = measure(&drawing, flag("--lift"), dump.map(Path::new));
        if flag("--each") {
            let line = match &result {
                Ok(m) => serde_json::json!({"id": drawing.id, "report": m.report}),
                Err(what) => serde_json::json!({"id": drawing.id, "error": what}),
            };
            println!("{line}");
        }
        match result {
            Ok(m) => {
                valid += 1;
                filled += m.report.filled.len();
                plan_ms.push(m.plan_ms);
                build_ms.push(m.build_ms);
                largest_tolerance =
                    largest_tolerance.max(m.report.largest_tolerance / drawing.size());
            }
            Err(what) => {
                let class: String = what.chars().filter(|c| !c.is_ascii_digit()).collect();
                let entry = if flag("--list") {
                    format!("{} {what}", drawing.id)
                } else {
                    drawing.id
                };
                failures.entry(class).or_default().push(entry);
            }
        }
    }
    println!(
        "{count} drawings, valid {:.1}%",
        100.0 * f64::from(valid) / count as f64
    );
    println!("filled faces {filled}, largest tolerance {largest_tolerance:.1e} of the size");
    println!(
        "median ms: plan {:.2}, build {:.2}",
        median(plan_ms),
        median(build_ms)
    );
    for (class, ids) in &failures {
        println!("{:4}  {class}", ids.len());
        for id in ids.iter().take(if flag("--list") { usize::MAX } else { 3 }) {
            println!("        {id}");
        }
    }
    Ok(())
}

struct Measured {
    report: SolidReport,
    plan_ms: f64,
    build_ms: f64,
}

fn is_simple(drawing: &Drawing) -> bool {
    let kinds = drawing.truth.iter().flat_map(|t| &t.faces).map(|f| f.kind);
    kinds
        .into_iter()
        .all(|k| matches!(k, SurfaceKind::Plane | SurfaceKind::Cylinder))
}

fn measure(drawing: &Drawing, lifted: bool, dump: Option<&Path>) -> Result<Measured, String> {
    let faces = from_truth(drawing).ok_or("no truth")?.faces;
    let lift = if lifted {
        let options = LiftOptions::default();
        lift(drawing, &faces, &options, Progress::none()).map_err(|e| e.to_string())?
    } else {
        truth::true_lift(drawing).ok_or("no truth")?
    };
    let start = Instant::now();
    let plan = plan(drawing, &faces, &lift, &PlanOptions::default()).map_err(|e| e.to_string())?;
    let plan_ms = start.elapsed().as_secs_f64() * 1e3;
    let start = Instant::now();
    let solid = build(&plan, Progress::none()).map_err(|e| {
        if let Some(folder) = dump {
            let name = drawing.id.replace(['/', '#'], "-");
            let json = serde_json::to_string(&plan).unwrap_or_default();
            let written =
                std::fs::write(folder.join(format!("{name}.json")), json).and_then(|()| {
                    std::fs::write(
                        folder.join(format!("{name}.brep")),
                        e.partial().unwrap_or_default(),
                    )
                });
            if let Err(e) = written {
                eprintln!("{name}: {e}");
            }
        }
        e.to_string()
    })?;
    Ok(Measured {
        report: solid.report().clone(),
        plan_ms,
        build_ms: start.elapsed().as_secs_f64() * 1e3,
    })
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}
