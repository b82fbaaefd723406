//! What a call returns.

/// What a call returns. Anything but `FACEFORMER_STATUS_OK` comes with a message.
#[repr(i32)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FaceformerStatus {
    /// Done.
    Ok = 0,
    /// The work failed on sound input; the message says why and what to do.
    Failed = 1,
    /// The input is wrong: a null pointer, no UTF-8, no JSON of the expected form, too large, or
    /// data that contradict each other.
    BadInput = 2,
    /// The progress callback asked to stop.
    Cancelled = 3,
    /// A fault inside the library. The handles given to the call stay usable.
    Panic = 4,
}
