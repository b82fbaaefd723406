//! Finds or builds OCCT, compiles the C++ side of the bridge and links both.
//!
//! Without features the system's shared OCCT is found with CMake; `OpenCASCADE_DIR` or
//! `CMAKE_PREFIX_PATH` point to another one. With the feature `bundled-occt` the static OCCT of the
//! crate `occt-sys` is compiled into `OCCT` in the target folder, once.

use std::path::{Path, PathBuf};

/// Toolkits that every version has, users before what they use, as static linking needs it.
const TOOLKITS: [&str; 10] = [
    "TKMesh",
    "TKShHealing",
    "TKTopAlgo",
    "TKGeomAlgo",
    "TKBRep",
    "TKGeomBase",
    "TKG3d",
    "TKG2d",
    "TKMath",
    "TKernel",
];

/// C++ files of the bridge, without folder and suffix.
const SOURCES: [&str; 14] = [
    "build",
    "chart",
    "check",
    "curve",
    "cusp",
    "face",
    "fill",
    "guard",
    "project",
    "properties",
    "quiet",
    "topology",
    "unroll",
    "write",
];

struct Occt {
    include: PathBuf,
    library: PathBuf,
    /// Toolkits of the exchange formats, users first.
    exchange: Vec<String>,
    /// How rustc links the toolkits.
    kind: &'static str,
}

fn main() {
    let occt = locate();
    let mut build = cxx_build::bridge("src/bridge.rs");
    build.std("c++17");
    if build.get_compiler().is_like_msvc() {
        build.include(&occt.include);
    } else {
        // As system headers, so that our own code can be compiled with warnings.
        build.flag("-isystem").flag(&occt.include);
    }
    for name in SOURCES {
        build.file(format!("cpp/{name}.cpp"));
    }
    build.compile("faceformer_occt_bridge");

    println!("cargo:rustc-link-search=native={}", occt.library.display());
    for toolkit in occt.exchange.iter().map(String::as_str).chain(TOOLKITS) {
        println!("cargo:rustc-link-lib={}={toolkit}", occt.kind);
    }
    println!("cargo:rerun-if-changed=src/bridge.rs");
    println!("cargo:rerun-if-changed=cpp");
    println!("cargo:rerun-if-changed=cmake");
    println!("cargo:rerun-if-env-changed=OpenCASCADE_DIR");
    println!("cargo:rerun-if-env-changed=CMAKE_PREFIX_PATH");
}

#[cfg(not(feature = "bundled-occt"))]
fn locate() -> Occt {
    let built = cmake::Config::new("cmake").no_build_target(true).build();
    let answer = built.join("build").join("occt.txt");
    let text = std::fs::read_to_string(&answer)
        .unwrap_or_else(|e| panic!("cannot read {}: {e}", answer.display()));
    let value = |key: &str| {
        text.lines()
            .find_map(|line| line.strip_prefix(key)?.strip_prefix('='))
            .unwrap_or_else(|| panic!("{} has no {key}", answer.display()))
    };
    let include = Path::new(value("include")).to_path_buf();
    if !include.join("Standard_Version.hxx").exists() {
        panic!(
            "the headers of OpenCASCADE {} are not in {}: install its development packages",
            value("version"),
            include.display()
        );
    }
    Occt {
        include,
        library: Path::new(value("library")).to_path_buf(),
        exchange: value("exchange").split(',').map(str::to_owned).collect(),
        kind: "dylib",
    }
}

#[cfg(feature = "bundled-occt")]
fn locate() -> Occt {
    occt_sys::build_occt();
    let root: PathBuf = occt_sys::occt_path();
    // The frameworks behind STEP are named too: the linker takes from them what is used.
    let exchange = [
        "TKDESTL", "TKDESTEP", "TKDE", "TKXSBase", "TKXCAF", "TKVCAF", "TKCAF", "TKLCAF", "TKCDF",
    ];
    let built = |name: &&str| {
        Path::new(&root)
            .join("lib")
            .join(format!("lib{name}.a"))
            .exists()
    };
    let exchange = exchange.iter().filter(|n| cfg!(windows) || built(n));
    Occt {
        include: root.join("include"),
        library: root.join("lib"),
        exchange: exchange.map(|name| (*name).to_owned()).collect(),
        // Kept out of the rlib: a static OCCT is hundreds of megabytes.
        kind: "static:-bundle",
    }
}
