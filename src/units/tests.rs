use super::*;

/// The value that a quantity string is read as, or the message.
fn value<T: FromStr<Err = Error> + Copy>(text: &str, inside: fn(T) -> f64) -> std::result::Result<f64, String> {
    text.parse::<T>().map(inside).map_err(|e| e.to_string())
}

macro_rules! reads {
    ($name:ident: $($text:literal => $expected:expr),+ $(,)?) => {
        $(assert_eq!(value::<$name>($text, |q| q.0), Ok($expected), $text);)+
    };
}

#[test]
fn good_quantities_have_their_exact_values() {
    reads!(Energy:
        "10 meV" => 10.0, "10meV" => 10.0, "-0.25 meV" => -0.25, "1e-3 eV" => 1.0, "1E3ueV" => 1.0, "+3 eV" => 3000.0,
        "0.1 µeV" => 1e-4, "0.1 μeV" => 1e-4, " 5 neV " => 5e-6, "\u{2212}1 meV" => -1.0, ".5 meV" => 0.5, "5. meV" => 5.0,
        "0 J" => 0.0, "1.602176634e-22 J" => 1.0, "1.602176634e-15 erg" => 1.0,  "1 Ry" => RYDBERG,
        "1 mRy" => 13.605693122990, "0.000000000000000000000000000000000001e36 meV" => 1.0,
        "1 T A m^2" => 1e22 / 1.602176634,
    );
    reads!(Moment: "2 mu_B" => 2.0, "3 μ_B" => 3.0, "3 µ_B" => 3.0, "3 μB" => 3.0, "3 muB" => 3.0, "0 A m^2" => 0.0,
        "1e-23 A m^2" => 10.0 / (5.7883817982 * 1.602176634), "1e-23 A·m²" => 10.0 / (5.7883817982 * 1.602176634),
        "1e-23 J/T" => 10.0 / (5.7883817982 * 1.602176634),
    );
    reads!(FluxDensity: "50 mT" => 0.05, "+3 T" => 3.0, "100 Oe" => 0.01, "1 kOe" => 0.1, "5 G" => 5e-4, "5 kG" => 0.5,
        "1 A/m" => 1e-6 * 1.25663706127, "1 MA/m" => 1.25663706127, "1 GA/m" => 1e3 * 1.25663706127,
    );
    reads!(ExchangeStiffness: "13 pJ/m" => 13e-12, "1e-6 erg/cm" => 1e-11, "1.3 uerg/cm" => 1.3e-11, "13e-12J/m" => 13e-12);
    reads!(SurfaceEnergy: "3 mJ/m^2" => 3e-3, "3 mJ/m²" => 3e-3, "3 mJ m^-2" => 3e-3, "3 mJ m⁻²" => 3e-3,
        "1 erg/cm^2" => 1e-3, "1 erg/cm²" => 1e-3, "3 mJ/m2" => 3e-3, "1 meV/nm^2" => 1e-4 * 1.602176634,
    );
    reads!(EnergyDensity: "0 J/m^3" => 0.0, "500 kJ/m^3" => 5e5, "0.5 MJ/m³" => 5e5, "5e6 erg/cm^3" => 5e5, "5 Merg/cc" => 5e5);
    reads!(Magnetisation: "800 kA/m" => 8e5, "800 emu/cm^3" => 8e5, "800 emu/cc" => 8e5, "1.4e6 A/m" => 1.4e6);
    reads!(Length: "0.25 nm" => 0.25, "2.5 angstrom" => 0.25, "2.5 Å" => 0.25, "2.5 \u{212B}" => 0.25, "250 pm" => 0.25,
        "1e-9 m" => 1.0, "1 um" => 1e3, "1 cm" => 1e7,
    );
    reads!(Temperature: "300 K" => 300.0, "4.2 mK" => 4.2e-3);
    reads!(Time: "1 ps" => 1.0, "1 ns" => 1e3, "1e-12 s" => 1.0, "5 fs" => 5e-3);
    reads!(Angle: "2 rad" => 2.0, "180 deg" => std::f64::consts::PI, "90 deg" => std::f64::consts::FRAC_PI_2,
        "-45°" => -std::f64::consts::FRAC_PI_4, "5 mrad" => 5e-3,
    );
}

#[test]
fn the_dimension_chooses_between_an_energy_and_a_density() {
    let site = |text: &str| text.parse::<SiteEnergy>().map_err(|e| e.to_string());
    assert_eq!(site("0.5 meV"), Ok(SiteEnergy::PerSite(Energy(0.5))));
    assert_eq!(site("500 kJ/m^3"), Ok(SiteEnergy::PerVolume(EnergyDensity(5e5))));
    let bond = |text: &str| text.parse::<BondEnergy>().map_err(|e| e.to_string());
    assert_eq!(bond("1.5 meV"), Ok(BondEnergy::PerBond(Energy(1.5))));
    assert_eq!(bond("3.2 mJ/m²"), Ok(BondEnergy::PerArea(SurfaceEnergy(3.2e-3))));
}

#[test]
fn a_quantity_written_is_the_quantity_read_again() {
    for x in [0.0, -0.25, 1.0 / 3.0, 1e-300, 6.02e23, f64::MAX, f64::MIN_POSITIVE, 12345678.9] {
        let written = serde_json::to_string(&Energy(x)).unwrap();
        assert_eq!(serde_json::from_str::<Energy>(&written).unwrap(), Energy(x), "{written}");
        assert_eq!(Magnetisation(x).to_string().parse::<Magnetisation>().unwrap(), Magnetisation(x));
        assert_eq!(Moment(x).to_string().parse::<Moment>().unwrap(), Moment(x));
        assert_eq!(Length(x).to_string().parse::<Length>().unwrap(), Length(x));
        assert_eq!(Time(x).to_string().parse::<Time>().unwrap(), Time(x));
    }
    assert_eq!(serde_json::to_string(&Energy(10.0)).unwrap(), r#""10 meV""#);
    assert_eq!(serde_json::to_string(&SiteEnergy::PerVolume(EnergyDensity(5e5))).unwrap(), r#""500000 J/m^3""#);
    assert!(serde_json::to_string(&Energy(f64::NAN)).is_err());
}

#[test]
fn conversions_agree_with_the_constants() {
    let close = |a: f64, b: f64| assert!((a - b).abs() <= 4.0 * f64::EPSILON * b.abs(), "{a} is not {b}");
    close(Energy(1.0).joules(), 1e-3 * E_CHARGE);
    close(Energy::from_joules(1e-21).joules(), 1e-21);
    close(Energy(K_B).temperature().0, 1.0);
    close(Temperature(300.0).energy().0, 25.851999786);
    // A cell of Permalloy, 5 nm × 5 nm × 5 nm: Ms V = 1e-19 A m².
    let mu_b = MU_B_MEV_PER_T * 1e-3 * E_CHARGE;
    close(Magnetisation(8e5).in_volume(125.0).0, 1e-19 / mu_b);
    close(EnergyDensity(5e5).in_volume(125.0).joules(), 6.25e-20);
    close(SurfaceEnergy(3e-3).over_area(25.0).joules(), 7.5e-20);
    close(ExchangeStiffness(13e-12).over_length(5.0).joules(), 6.5e-20);
    close(Moment(2.0).in_field(FluxDensity(0.5)).0, MU_B_MEV_PER_T);
    close("9.2740100657e-24 J/T".parse::<Moment>().unwrap().0, 9.2740100657e-24 / mu_b);
}
