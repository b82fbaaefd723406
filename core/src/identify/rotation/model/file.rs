//! The rotation engine's model files; see [`weights`] for their form and their checks.

use std::path::Path;

use super::ModelError;
use super::network::{Config, Network};
use crate::identify::weights::{self, Described};

/// Most bytes of weights.
pub const LIMIT: u64 = 24 << 20;

impl Described for Config {
    fn is_supported(&self) -> bool {
        self.is_supported()
    }

    fn shapes(&self) -> Vec<(String, Vec<usize>)> {
        self.shapes()
    }
}

/// Reads a model from its two files.
///
/// # Errors
/// [`ModelError`].
pub fn read(weights: &Path) -> Result<Network, ModelError> {
    let (bytes, description) = weights::read(weights, LIMIT)?;
    load(bytes, &description)
}

/// Checks weights against their description and makes the network.
///
/// # Errors
/// [`ModelError`].
pub fn load(weights: Vec<u8>, description: &str) -> Result<Network, ModelError> {
    let (config, vb) = weights::checked(weights, description, LIMIT)?;
    Network::new(config, &vb).map_err(|e| ModelError::Weights(e.to_string()))
}
