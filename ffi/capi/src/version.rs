//! The version of the ABI. The build script reads this file as well, for the library's soname.

/// Version of this interface. It grows when a function, a type or the meaning of a JSON field
/// changes so that an old caller would break; additions leave it.
pub const FACEFORMER_ABI_VERSION: u32 = 1;
