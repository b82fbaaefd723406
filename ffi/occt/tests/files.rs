//! Files of a solid, and the text that goes to FreeCAD.

mod common;

use common::{cylinder, drilled_block};
use faceformer::Progress;
use faceformer_occt::{Format, OcctError, build, occt_version};

#[test]
fn brep_is_version_1_text() {
    let solid = build(&drilled_block(), Progress::none()).unwrap();
    let text = String::from_utf8(solid.brep().unwrap()).unwrap();
    assert!(text.contains("CASCADE Topology V1,"), "{}", &text[..80]);
}

#[test]
fn step_file_holds_a_cylinder_and_no_facets() {
    let solid = build(&drilled_block(), Progress::none()).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("gebohrt \u{e4}.step");
    solid.write(&path, Format::Step).unwrap();
    let text = std::fs::read_to_string(&path).unwrap();
    assert!(text.starts_with("ISO-10303-21;"));
    assert!(text.trim_end().ends_with("END-ISO-10303-21;"));
    assert_eq!(text.matches("CYLINDRICAL_SURFACE(").count(), 1);
    assert_eq!(text.matches("ADVANCED_FACE(").count(), 7);
    assert_eq!(text.matches("MANIFOLD_SOLID_BREP(").count(), 1);
    assert!(text.contains("'Faceformer"));
}

#[test]
fn step_files_can_be_written_from_many_threads() {
    let solid = build(&cylinder(), Progress::none()).unwrap();
    let folder = tempfile::tempdir().unwrap();
    std::thread::scope(|scope| {
        for i in 0..4 {
            let path = folder.path().join(format!("{i}.step"));
            let solid = &solid;
            scope.spawn(move || {
                for _ in 0..5 {
                    solid.write(&path, Format::Step).unwrap();
                }
            });
        }
    });
    for i in 0..4 {
        let text = std::fs::read_to_string(folder.path().join(format!("{i}.step"))).unwrap();
        assert_eq!(text.matches("ADVANCED_FACE(").count(), 3);
    }
}

#[test]
fn stl_triangles_enclose_the_volume() {
    let solid = build(&cylinder(), Progress::none()).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("cylinder.stl");
    solid.write(&path, Format::Stl).unwrap();
    let bytes = std::fs::read(&path).unwrap();
    let count = u32::from_le_bytes(bytes[80..84].try_into().unwrap()) as usize;
    assert_eq!(bytes.len(), 84 + 50 * count);
    let number = |at: usize| f64::from(f32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()));
    let corner = |t: usize, k: usize| {
        let at = 84 + 50 * t + 12 * (k + 1);
        glam::DVec3::new(number(at), number(at + 4), number(at + 8))
    };
    let volume: f64 = (0..count)
        .map(|t| corner(t, 0).dot(corner(t, 1).cross(corner(t, 2))) / 6.0)
        .sum();
    let wanted = solid.report().volume;
    assert!(
        volume > 0.985 * wanted && volume < wanted,
        "{volume} of {wanted}"
    );
}

#[test]
fn folder_that_is_not_there_is_an_error() {
    let solid = build(&cylinder(), Progress::none()).unwrap();
    let folder = tempfile::tempdir().unwrap();
    for format in [Format::Step, Format::Brep, Format::Stl] {
        let error = solid
            .write(&folder.path().join("no/such/file"), format)
            .unwrap_err();
        assert!(matches!(error, OcctError::Write { .. }), "{error}");
    }
}

#[test]
fn formats_have_names() {
    assert_eq!("STP".parse(), Ok(Format::Step));
    assert_eq!("brep".parse(), Ok(Format::Brep));
    assert_eq!("stl".parse(), Ok(Format::Stl));
    assert!("dwg".parse::<Format>().is_err());
}

#[test]
fn version_is_one_that_is_supported() {
    let version = occt_version().unwrap();
    assert!(version.starts_with("7."), "{version}");
}
