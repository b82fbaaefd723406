//! Model files: safetensors weights, and beside them a JSON description with their SHA-256.
//!
//! `weights.safetensors` goes with `weights.json`, `{"model": {...}, "sha256": "..."}`; the
//! training package's `export` writes both. Nothing of the weights is used before all of it is
//! checked.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::Read;
use std::path::Path;

use candle_core::{DType, Device};
use candle_nn::VarBuilder;
use safetensors::{Dtype, SafeTensors};
use serde::Deserialize;
use sha2::{Digest, Sha256};

use super::ModelError;
use super::network::{Config, Network};

/// Most bytes of weights.
pub const LIMIT: u64 = 24 << 20;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Description {
    model: Config,
    sha256: String,
}

/// Reads a model from its two files.
///
/// # Errors
/// [`ModelError`].
pub fn read(weights: &Path) -> Result<Network, ModelError> {
    let bytes = limited(weights)?;
    let description = limited(&weights.with_extension("json"))?;
    let description = String::from_utf8(description)
        .map_err(|_| ModelError::Description("it is not UTF-8 text".to_owned()))?;
    load(bytes, &description)
}

fn limited(path: &Path) -> Result<Vec<u8>, ModelError> {
    let fail = |e: std::io::Error| ModelError::Read {
        path: path.display().to_string(),
        what: e.to_string(),
    };
    let mut bytes = Vec::new();
    let file = File::open(path).map_err(fail)?;
    file.take(LIMIT + 1).read_to_end(&mut bytes).map_err(fail)?;
    Ok(bytes)
}

/// Checks weights against their description and makes the network.
///
/// # Errors
/// [`ModelError`].
pub fn load(weights: Vec<u8>, description: &str) -> Result<Network, ModelError> {
    if weights.len() as u64 > LIMIT {
        return Err(ModelError::TooLarge {
            bytes: weights.len() as u64,
            limit: LIMIT,
        });
    }
    let Description { model, sha256 } =
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
    let fail = |e: candle_core::Error| ModelError::Weights(e.to_string());
    let vb = VarBuilder::from_buffered_safetensors(weights, DType::F32, &Device::Cpu);
    Network::new(model, &vb.map_err(fail)?).map_err(fail)
}

/// Checks names, shapes and values.
fn check(weights: &[u8], config: &Config) -> Result<(), ModelError> {
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
