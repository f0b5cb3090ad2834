//! Rates of tests, over saddles that slide or do not.

use super::{Pinning, Prefactor, RateSettings, Refusal, SaddleRate, Theory, ZeroKind, ZeroModes, refused};

/// How high the hop of a sliding state from place to place is (meV).
pub const HOP_MEV: f64 = 1e-6;

/// By both theories, at these temperatures (K).
pub fn settings(temperatures_k: &[f64]) -> RateSettings {
    RateSettings {
        temperatures_k: temperatures_k.to_vec(),
        damping: 0.3,
        g_factor: 2.0,
        theories: Theory::ALL.to_vec(),
        moments_mub: Vec::new(),
    }
}

/// The rates over a saddle of such barriers (meV), between states that slide in two directions or do not.
pub fn both(saddle: usize, ln_hz: f64, barriers_mev: [f64; 2], slide: [bool; 2]) -> [SaddleRate; 2] {
    let mut both = refused(saddle, &settings(&[]), barriers_mev.map(Some), &Refusal::Path(String::new()));
    let prefactor = Prefactor { frequency_per_s: 1e12, ln_hz, exponent: 0.0, pinning: Default::default() };
    let translation = ZeroModes {
        kind: ZeroKind::Translation,
        count: 2,
        volume: 6e3,
        hop_volume: None,
        pinning: vec![Pinning { curved_mev: HOP_MEV, top_mev: HOP_MEV }; 2],
    };
    for (rate, slides) in both.iter_mut().zip(slide) {
        let rate = &mut rate.regimes[0];
        (rate.htst, rate.langer, rate.refused) = (Some(prefactor), Some(prefactor), Vec::new());
        rate.minimum_zeros = if slides { vec![translation.clone()] } else { Vec::new() };
    }
    both
}
