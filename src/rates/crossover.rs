//! The temperature below which a state leaves by tunnelling rather than over the saddle.
//!
//! ```text
//! T_c = ħ λ₊/(2π k_B)
//! ```
//! with the growth rate λ₊ of the unstable mode at the saddle, damping included (Langer's; without damping that of the precession
//! alone). In imaginary time a path that rests on the saddle fluctuates by H + ν(α − R)Γ⁻¹ at the Matsubara frequencies
//! ν = 2πn k_BT/ħ, Γ⁻¹R from the Berry phase and αΓ⁻¹ from a bath of that damping: the determinant whose one positive zero is λ₊
//! (module `growth`). Below T_c the first of the frequencies lies under λ₊, the saddle is unstable against periodic paths of that
//! frequency, and they tunnel. One spin of S ħ with E = −K m_z² + K_hard m_x² has λ₊ = 2√(K K_hard)/(S ħ) undamped, and
//! k_B T_c = √(K K_hard)/(π S).
//!
//! Limits. It is where the saddle gives way to paths near it (a crossover of second order). Where paths far from it win first (of
//! first order: one such spin with K_hard < K), tunnelling takes over at a higher temperature, and T_c is a lower bound. The
//! moments are taken as large; quantisation, and the interference of ways that turn to either side (half-integer spins), are left
//! out. A saddle about which a symmetry conserves the moment has no unstable mode without damping, does not tunnel, and has no T_c.
//!
//! Any dissipative system: P. Hänggi, P. Talkner, M. Borkovec, Rev. Mod. Phys. 62, 251 (1990), doi:10.1103/RevModPhys.62.251,
//! section IX; one spin: E. M. Chudnovsky, L. Gunther, Phys. Rev. Lett. 60, 661 (1988), doi:10.1103/PhysRevLett.60.661; the order
//! of the crossover: E. M. Chudnovsky, D. A. Garanin, Phys. Rev. Lett. 79, 4469 (1997), doi:10.1103/PhysRevLett.79.4469; many spins:
//! S. Vlasov, P. F. Bessarab, V. M. Uzdin, H. Jónsson, Faraday Discuss. 195, 93 (2016), doi:10.1039/C6FD00136J.

use crate::units::{HBAR, K_B};
use std::f64::consts::PI;

/// T_c (K) from λ₊ (rad/s).
pub fn crossover_temperature(growth_per_s: f64) -> f64 {
    // ħ is in meV ps
    1e-12 * HBAR * growth_per_s / (2.0 * PI * K_B)
}
