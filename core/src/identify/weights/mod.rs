//! Model files: safetensors weights, and beside them a JSON description with their SHA-256.
//!
//! `weights.safetensors` goes with `weights.json`, `{"model": {...}, "sha256": "..."}`; the
//! training package's `export` commands write both. Nothing of the weights is used before all of it
//! is checked.

mod error;

use std::collections::BTreeMap;
use std::fs::File;
use std::io::Read;
use std::path::Path;

use candle_core::{DType, Device};
use candle_nn::VarBuilder;
use safetensors::{Dtype, SafeTensors};
use serde::Deserialize;
use serde::de::DeserializeOwned;
use sha2::{Digest, Sha256};

pub use error::ModelError;

/// The size of a network as its description says it.
pub(crate) trait Described: DeserializeOwned {
    /// Whether this version has such a network, and it is of a sane size.
    fn is_supported(&self) -> bool;

    /// Names and shapes of all weights.
    fn shapes(&self) -> Vec<(String, Vec<usize>)>;
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Description<C> {
    model: C,
    sha256: String,
}

/// Reads weights and the description beside them, unchecked and at most `limit` bytes of each.
///
/// # Errors
/// [`ModelError::Read`], [`ModelError::Description`].
pub(crate) fn read(weights: &Path, limit: u64) -> Result<(Vec<u8>, String), ModelError> {
    let bytes = limited(weights, limit)?;
    let description = limited(&weights.with_extension("json"), limit)?;
    let description = String::from_utf8(description)
        .map_err(|_| ModelError::Description("it is not UTF-8 text".to_owned()))?;
    Ok((bytes, description))
}

fn limited(path: &Path, limit: u64) -> Result<Vec<u8>, ModelError> {
    let fail = |e: std::io::Error| ModelError::Read {
        path: path.display().to_string(),
        what: e.to_string(),
    };
    let mut bytes = Vec::new();
    let file = File::open(path).map_err(fail)?;
    file.take(limit + 1).read_to_end(&mut bytes).map_err(fail)?;
    Ok(bytes)
}

/// Checks weights against their description.
///
/// # Errors
/// [`ModelError`].
pub(crate) fn checked<C: Described>(
    weights: Vec<u8>,
    description: &str,
    limit: u64,
) -> Result<(C, VarBuilder<'static>), ModelError> {
    if weights.len() as u64 > limit {
        return Err(ModelError::TooLarge {
            bytes: weights.len() as u64,
            limit,
        });
    }
    let Description::<C> { model, sha256 } =
        serde_json::from_str(description).map_err(|e| ModelError::Description(e.to_string()))?;
    if !model.is_supported() {
        return Err(ModelError::Version);
    }
    let digest = Sha256::digest(&weights);
    let found: String = digest.iter().map(|b| format!("{b:02x}")).collect();
    if found != sha256 {
        return Err(ModelError::Hash {
            expected: sha256,
            found,
        });
    }
    check(&weights, &model)?;
    let vb = VarBuilder::from_buffered_safetensors(weights, DType::F32, &Device::Cpu);
    Ok((model, vb.map_err(|e| ModelError::Weights(e.to_string()))?))
}

/// Checks names, shapes and values.
fn check<C: Described>(weights: &[u8], config: &C) -> Result<(), ModelError> {
    let tensors =
        SafeTensors::deserialize(weights).map_err(|e| ModelError::Weights(e.to_string()))?;
    let mut expected: BTreeMap<String, Vec<usize>> = config.shapes().into_iter().collect();
    for (name, view) in tensors.iter() {
        let Some(shape) = expected.remove(name) else {
            return Err(ModelError::Unexpected(name.to_owned()));
        };
        if view.shape() != shape {
            return Err(ModelError::Shape {
                name: name.to_owned(),
                expected: shape,
                found: view.shape().to_vec(),
            });
        }
        let data = view.data();
        let finite = match view.dtype() {
            Dtype::F32 => data
                .chunks_exact(4)
                .all(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]]).is_finite()),
            Dtype::F16 => data
                .chunks_exact(2)
                .all(|b| half::f16::from_le_bytes([b[0], b[1]]).is_finite()),
            _ => false,
        };
        if !finite {
            return Err(ModelError::Values(name.to_owned()));
        }
    }
    match expected.into_keys().next() {
        Some(name) => Err(ModelError::Missing(name)),
        None => Ok(()),
    }
}
