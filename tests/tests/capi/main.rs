//! The C ABI as programs see it: the built shared library, its symbols, its installation, and a C
//! and a C++ program that use it.
//!
//! `FACEFORMER_LIBRARY` names a ready library to test instead of the one cargo builds, for
//! instance one with the bundled OpenCASCADE.

mod abi;
mod bad_input;
mod conflicts;
mod consumers;
mod exports;
mod library;
