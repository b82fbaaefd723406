//! Linker arguments of the shared library: what it exports, and under which name it is loaded.

// Public in the library, and nobody sees it here.
#[allow(unreachable_pub)]
#[path = "src/version.rs"]
mod version;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed=src/version.rs");
    let family = std::env::var("CARGO_CFG_TARGET_FAMILY").unwrap_or_default();
    let vendor = std::env::var("CARGO_CFG_TARGET_VENDOR").unwrap_or_default();
    let abi = version::FACEFORMER_ABI_VERSION;
    if vendor == "apple" {
        println!(
            "cargo::rustc-cdylib-link-arg=-Wl,-install_name,@rpath/libfaceformer_capi.{abi}.dylib"
        );
    } else if family.split(',').any(|f| f == "unix") {
        // A soname with the ABI's version, as usual: a program built against one ABI never
        // starts with a library of another.
        println!("cargo::rustc-cdylib-link-arg=-Wl,-soname,libfaceformer_capi.so.{abi}");
        // What comes from static archives stays inside: cxx's own symbols, and OpenCASCADE's in
        // the feature `bundled-occt`. Exported, they would stand in for those of the OpenCASCADE
        // that FreeCAD has loaded, of another version, and crash it.
        println!("cargo::rustc-cdylib-link-arg=-Wl,--exclude-libs,ALL");
    }
}
