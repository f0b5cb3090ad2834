//! Angular velocity along slerp, nlerp and lerp between two spins.
//!
//! slerp turns at a constant rate. nlerp goes through the same points, in the middle 1/cos²(θ/2) times as fast as at the
//! ends. lerp turns as nlerp does and leaves the sphere: in the middle its length is cos(θ/2).
//!
//! ```text
//! cargo run --release --example 01_slerp_versus_nlerp
//! ```
//! prints a table and writes `results/gallery/01_slerp_versus_nlerp/angular_velocity.csv`, `.svg` and `.png`.

use spinneb::geometry::{Direction, Vector, angular_velocity, lerp, nlerp, slerp, unevenness, vector::norm};
use spinneb::output::canvas::{BLACK, LinePlot, ORANGE, SKY, Series, VERMILLION};
use std::fmt::Write;
use std::path::Path;

const ANGLES_DEG: [f64; 4] = [30.0, 90.0, 150.0, 179.0];
const STEPS: usize = 1000;
/// Every so many steps are drawn,
const DRAWN: usize = 4;
/// and written to the table.
const EVERY: usize = 20;
const FOLDER: &str = "results/gallery/01_slerp_versus_nlerp";

/// One way from one spin to the other.
struct Curve {
    method: &'static str,
    angle_deg: f64,
    /// Angular velocity divided by its mean, at the middle of each step.
    relative_velocity: Vec<f64>,
    unevenness: f64,
    shortest: f64,
}

fn main() -> anyhow::Result<()> {
    let curves = curves();
    print!("{}", table(&curves));
    std::fs::create_dir_all(FOLDER)?;
    let file = Path::new(FOLDER).join("angular_velocity.csv");
    std::fs::write(&file, csv(&curves))?;
    let canvas = figure(&curves).draw()?;
    std::fs::write(file.with_extension("svg"), canvas.svg()?)?;
    std::fs::write(file.with_extension("png"), canvas.png()?)?;
    println!("\nwritten: {}, .svg and .png", file.display());
    Ok(())
}

/// All methods at all angles.
fn curves() -> Vec<Curve> {
    let (a, z) = ([1.0, 0.0, 0.0], Direction::Z);
    ANGLES_DEG
        .into_iter()
        .flat_map(|angle_deg| {
            let theta = angle_deg.to_radians();
            let b = [libm::cos(theta), libm::sin(theta), 0.0];
            [
                curve("slerp", angle_deg, |t| slerp(a, b, t, z)),
                curve("nlerp", angle_deg, |t| nlerp(a, b, t, z)),
                curve("lerp", angle_deg, |t| lerp(a, b, t)),
            ]
        })
        .collect()
}

fn curve(method: &'static str, angle_deg: f64, at: impl Fn(f64) -> Vector) -> Curve {
    let path: Vec<Vector> = (0..=STEPS).map(|k| at(k as f64 / STEPS as f64)).collect();
    let velocity = angular_velocity(&path, 1.0 / STEPS as f64);
    let mean = velocity.iter().sum::<f64>() / STEPS as f64;
    Curve {
        method,
        angle_deg,
        unevenness: unevenness(&velocity),
        relative_velocity: velocity.iter().map(|omega| omega / mean).collect(),
        shortest: path.iter().map(|&p| norm(p)).fold(f64::INFINITY, f64::min),
    }
}

/// slerp and nlerp; lerp turns as nlerp does. The largest angle is left to the table: its peak would dwarf the rest.
fn figure(curves: &[Curve]) -> LinePlot {
    let colours = [SKY, ORANGE, VERMILLION];
    let mut plot = LinePlot::new("Fraction t of the way", "Angular velocity / mean").x_range(0.0, 1.0);
    let drawn = curves.iter().filter(|c| c.angle_deg < 179.0 && c.method != "lerp");
    for c in drawn {
        let points: Vec<(f64, f64)> = c
            .relative_velocity
            .iter()
            .enumerate()
            .step_by(DRAWN)
            .map(|(k, v)| ((k as f64 + 0.5) / STEPS as f64, *v))
            .collect();
        let index = ANGLES_DEG.iter().position(|a| *a == c.angle_deg).unwrap_or(0);
        let series = Series::line(points);
        if c.method == "nlerp" {
            plot = plot.with(series.colour(colours[index]).label(format!("nlerp, {:.0}°", c.angle_deg)));
        } else if index == 0 {
            plot = plot.with(series.colour(BLACK).label("slerp, any angle").dash(6.0, 4.0));
        }
    }
    plot
}

fn table(curves: &[Curve]) -> String {
    let mut text =
        String::from("angle   method   ω/mean, first step   in the middle    max/min − 1   shortest vector\n");
    for c in curves {
        let (end, middle) = (c.relative_velocity[0], c.relative_velocity[STEPS / 2]);
        let _ = writeln!(
            text,
            "{:4.0}°   {:6} {end:20.6} {middle:15.6} {:14.2e} {:17.6}",
            c.angle_deg,
            c.method,
            c.unevenness - 1.0,
            c.shortest
        );
    }
    text
}

/// A column for t (the middle of each step) and one for each curve.
fn csv(curves: &[Curve]) -> String {
    let mut text = String::from("t");
    for c in curves {
        let _ = write!(text, ",{}_{}deg", c.method, c.angle_deg);
    }
    for k in (0..STEPS).step_by(EVERY) {
        let _ = write!(text, "\n{}", (k as f64 + 0.5) / STEPS as f64);
        for c in curves {
            let _ = write!(text, ",{:.6}", c.relative_velocity[k]);
        }
    }
    text.push('\n');
    text
}
