//! Whole-path tests live in this package's test files; the library is empty.
