//! The committed header is what the sources say. `FACEFORMER_BLESS=1` writes it anew.

use std::path::Path;

#[test]
fn header_is_up_to_date() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let config = cbindgen::Config::from_file(root.join("cbindgen.toml")).unwrap();
    let mut bytes = Vec::new();
    cbindgen::generate_with_config(root, config)
        .unwrap()
        .write(&mut bytes);
    let generated = String::from_utf8(bytes).unwrap();

    let path = root.join("include/faceformer.h");
    if std::env::var_os("FACEFORMER_BLESS").is_some() {
        std::fs::write(&path, generated).unwrap();
        return;
    }
    let committed = std::fs::read_to_string(&path)
        .unwrap()
        .replace("\r\n", "\n");
    assert!(
        committed == generated,
        "{} is old; run the test once with FACEFORMER_BLESS=1",
        path.display()
    );
}
