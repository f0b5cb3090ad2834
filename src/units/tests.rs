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

/// Checks the whole messages about values that are no quantity of the type.
macro_rules! refuses {
    ($name:ident: $($found:tt => $message:literal),+ $(,)?) => {
        $(assert_eq!(
            serde_json::from_value::<$name>(serde_json::json!($found)).map_err(|e| e.to_string()),
            Err($message.to_string())
        );)+
    };
}

#[test]
fn bad_quantities_are_refused_with_what_would_do() {
    refuses! { Energy:
        10 => r#"found the number 10, but an energy needs its unit: write "10 meV" (J, eV, Ry or erg, with SI prefixes)"#,
        (-3) => r#"found the number -3, but an energy needs its unit: write "-3 meV" (J, eV, Ry or erg, with SI prefixes)"#,
        0.5 => r#"found the number 0.5, but an energy needs its unit: write "0.5 meV" (J, eV, Ry or erg, with SI prefixes)"#,
        1e-22 => r#"found the number 1e-22, but an energy needs its unit: write "1e-22 J" (J, eV, Ry or erg, with SI prefixes)"#,
        true => r#"invalid type: boolean `true`, expected an energy with its unit, such as "10 meV""#,
        null => r#"invalid type: null, expected an energy with its unit, such as "10 meV""#,
        [1] => r#"invalid type: sequence, expected an energy with its unit, such as "10 meV""#,
        {} => r#"invalid type: map, expected an energy with its unit, such as "10 meV""#,
        "10" => r#""10" has no unit, but an energy needs one: write "10 meV" (J, eV, Ry or erg, with SI prefixes)"#,
        "13 pJ/m" => r#""13 pJ/m" is an exchange stiffness, but an energy is wanted here: J, eV, Ry or erg, with SI prefixes"#,
        "10 mev" => r#"unknown unit "mev" in "10 mev": did you mean "meV"? (J, eV, Ry or erg, with SI prefixes)"#,
        "10 MEV" => r#"unknown unit "MEV" in "10 MEV": did you mean "meV"? (J, eV, Ry or erg, with SI prefixes)"#,
        "10 Mev" => r#"unknown unit "Mev" in "10 Mev": did you mean "meV"? (J, eV, Ry or erg, with SI prefixes)"#,
        "10 MeV" => r#""MeV" in "10 MeV" is refused, since so large a unit is all but surely a slip: did you mean "meV"? (J, eV, Ry or erg, with SI prefixes)"#,
        "10 kRY" => r#"unknown unit "kRY" in "10 kRY": did you mean "kRy"? (J, eV, Ry or erg, with SI prefixes)"#,
        "10 ergs" => r#"unknown unit "ergs" in "10 ergs": did you mean "erg"? (J, eV, Ry or erg, with SI prefixes)"#,
        "10 joule" => r#"unknown unit "joule" in "10 joule": did you mean "J"? (J, eV, Ry or erg, with SI prefixes)"#,
        "10 flops" => r#"unknown unit "flops" in "10 flops": an energy is wanted here: J, eV, Ry or erg, with SI prefixes"#,
        "" => r#""" does not begin with a number: an energy is wanted, such as "10 meV""#,
        "meV" => r#""meV" does not begin with a number: an energy is wanted, such as "10 meV""#,
        "nan meV" => r#""nan meV" is not a finite number: an energy is wanted, such as "10 meV""#,
        "-inf meV" => r#""-inf meV" is not a finite number: an energy is wanted, such as "10 meV""#,
        "1e400 meV" => r#""1e400 meV" is too large for a double-precision number"#,
        "1e-400 meV" => r#""1e-400 meV" is too small for a double-precision number: write 0 if that is meant"#,
        "1e99999999999999999999 meV" => r#""1e99999999999999999999 meV" is too large for a double-precision number"#,
        "0,5 meV" => r#"the number in "0,5 meV" is not readable: write it with a decimal point and without grouping digits, such as "10 meV""#,
        "1_000 meV" => r#"the number in "1_000 meV" is not readable: write it with a decimal point and without grouping digits, such as "10 meV""#,
        "1 000 meV" => r#"the number in "1 000 meV" is not readable: write it with a decimal point and without grouping digits, such as "10 meV""#,
        "1'000 meV" => r#"the number in "1'000 meV" is not readable: write it with a decimal point and without grouping digits, such as "10 meV""#,
        "1.2.3 meV" => r#"the number in "1.2.3 meV" has two decimal points"#,
        "10 meV please" => r#"unknown unit "please" in "10 meV please": an energy is wanted here: J, eV, Ry or erg, with SI prefixes"#,
        "10 meV;" => r#"found ";" where a unit should be in "10 meV;": an energy is wanted here: J, eV, Ry or erg, with SI prefixes"#,
        "10 meV /" => r#"found the end where a unit should be in "10 meV /": an energy is wanted here: J, eV, Ry or erg, with SI prefixes"#,
        "6e-21 J/link" => r#"leave out "/link" in "6e-21 J/link": what is counted has no unit"#,
        "6e-21 J/links" => r#"unknown unit "links" in "6e-21 J/links": an energy is wanted here: J, eV, Ry or erg, with SI prefixes"#,
        "1 J^1000" => r#"the power of J is not a whole number from -9 to 9 in "1 J^1000": an energy is wanted here: J, eV, Ry or erg, with SI prefixes"#,
        "1 J^" => r#"the power of J is not a whole number from -9 to 9 in "1 J^": an energy is wanted here: J, eV, Ry or erg, with SI prefixes"#,
        "1 J^2.5" => r#"the power of J is not a whole number from -9 to 9 in "1 J^2.5": an energy is wanted here: J, eV, Ry or erg, with SI prefixes"#,
        "1 J s" => r#""1 J s" is of a kind that is not used here, but an energy is wanted here: J, eV, Ry or erg, with SI prefixes"#,
        "5e" => r#"unknown unit "e" in "5e": an energy is wanted here: J, eV, Ry or erg, with SI prefixes"#,
        "1 meV ± 0.1" => r#"found "±" where a unit should be in "1 meV ± 0.1": an energy is wanted here: J, eV, Ry or erg, with SI prefixes"#,
        "ten meV" => r#""ten meV" does not begin with a number: an energy is wanted, such as "10 meV""#,
        "- 3 meV" => r#""- 3 meV" does not begin with a number: an energy is wanted, such as "10 meV""#,
        "--3 meV" => r#""--3 meV" does not begin with a number: an energy is wanted, such as "10 meV""#,
        "3 (meV)" => r#"found "(" where a unit should be in "3 (meV)": an energy is wanted here: J, eV, Ry or erg, with SI prefixes"#,
        "1 J J J J J J J J J" => r#"too long a unit in "1 J J J J J J J J J": an energy is wanted here: J, eV, Ry or erg, with SI prefixes"#,
        "1/2 meV" => r#"found "/" where a unit should be in "1/2 meV": an energy is wanted here: J, eV, Ry or erg, with SI prefixes"#,
    }
    refuses! { SiteEnergy:
        10 => r#"found the number 10, but an energy per site or per volume needs its unit: write "10 meV" or "10 J/m^3" (J, eV, Ry or erg for a site, J/m^3 or erg/cm^3 for a volume, with SI prefixes)"#,
        "10" => r#""10" has no unit, but an energy per site or per volume needs one: write "10 meV" or "10 J/m^3" (J, eV, Ry or erg for a site, J/m^3 or erg/cm^3 for a volume, with SI prefixes)"#,
        "3 mJ/m^2" => r#""3 mJ/m^2" is an energy per area, but an energy per site or per volume is wanted here: J, eV, Ry or erg for a site, J/m^3 or erg/cm^3 for a volume, with SI prefixes"#,
        "500 kj/m^3" => r#"unknown unit "kj" in "500 kj/m^3": did you mean "kJ"? (J, eV, Ry or erg for a site, J/m^3 or erg/cm^3 for a volume, with SI prefixes)"#,
        "500 KJ/m3" => r#"unknown unit "KJ" in "500 KJ/m3": did you mean "kJ"? (J, eV, Ry or erg for a site, J/m^3 or erg/cm^3 for a volume, with SI prefixes)"#,
    }
    refuses! { BondEnergy:
        1.5 => r#"found the number 1.5, but an energy per bond or per area needs its unit: write "1.5 meV" or "1.5 J/m^2" (J, eV, Ry or erg for a bond, J/m^2 or erg/cm^2 for an area, with SI prefixes)"#,
        "500 kJ/m^3" => r#""500 kJ/m^3" is an energy per volume, but an energy per bond or per area is wanted here: J, eV, Ry or erg for a bond, J/m^2 or erg/cm^2 for an area, with SI prefixes"#,
        "3 mj/m^2" => r#"unknown unit "mj" in "3 mj/m^2": did you mean "mJ"? (J, eV, Ry or erg for a bond, J/m^2 or erg/cm^2 for an area, with SI prefixes)"#,
    }
    refuses! { Moment:
        2 => r#"found the number 2, but a magnetic moment needs its unit: write "2 mu_B" (mu_B or A m^2, with SI prefixes)"#,
        "2 mu_b" => r#"unknown unit "mu_b" in "2 mu_b": did you mean "mu_B"? (mu_B or A m^2, with SI prefixes)"#,
        "2 MU_B" => r#"unknown unit "MU_B" in "2 MU_B": did you mean "mu_B"? (mu_B or A m^2, with SI prefixes)"#,
        "2 mub" => r#"unknown unit "mub" in "2 mub": did you mean "mu_B"? (mu_B or A m^2, with SI prefixes)"#,
        "2 Bohr" => r#"unknown unit "Bohr" in "2 Bohr": a magnetic moment is wanted here: mu_B or A m^2, with SI prefixes"#,
        "2 meV" => r#""2 meV" is an energy, but a magnetic moment is wanted here: mu_B or A m^2, with SI prefixes"#,
    }
    refuses! { FluxDensity:
        0.05 => r#"found the number 0.05, but a magnetic field needs its unit: write "0.05 T" (T, Oe, G or A/m, with SI prefixes)"#,
        "50 mt" => r#"unknown unit "mt" in "50 mt": did you mean "mT"? (T, Oe, G or A/m, with SI prefixes)"#,
        "5 tesla" => r#"unknown unit "tesla" in "5 tesla": did you mean "T"? (T, Oe, G or A/m, with SI prefixes)"#,
        "5 gauss" => r#"unknown unit "gauss" in "5 gauss": did you mean "G"? (T, Oe, G or A/m, with SI prefixes)"#,
        "5 Gs" => r#"unknown unit "Gs" in "5 Gs": did you mean "G"? (T, Oe, G or A/m, with SI prefixes)"#,
        "5 oe" => r#"unknown unit "oe" in "5 oe": did you mean "Oe"? (T, Oe, G or A/m, with SI prefixes)"#,
        "5 emu/cm^3" => r#""5 emu/cm^3" is a magnetisation (or a field H), but a magnetic field is wanted here: T, Oe, G or A/m, with SI prefixes"#,
        "5 ka/m" => r#"unknown unit "ka" in "5 ka/m": did you mean "kA"? (T, Oe, G or A/m, with SI prefixes)"#,
    }
    refuses! { ExchangeStiffness:
        13e-12 => r#"found the number 1.3e-11, but an exchange stiffness needs its unit: write "1.3e-11 J/m" (J/m or erg/cm, with SI prefixes)"#,
        "13 PJ/m" => r#"unknown unit "PJ" in "13 PJ/m": did you mean "pJ"? (J/m or erg/cm, with SI prefixes)"#,
        "13 pJ/M" => r#"unknown unit "M" in "13 pJ/M": did you mean "m"? (J/m or erg/cm, with SI prefixes)"#,
        "13 pJ" => r#""13 pJ" is an energy, but an exchange stiffness is wanted here: J/m or erg/cm, with SI prefixes"#,
        "13 pJ/m^2" => r#""13 pJ/m^2" is an energy per area, but an exchange stiffness is wanted here: J/m or erg/cm, with SI prefixes"#,
        "13 pN" => r#"unknown unit "pN" in "13 pN": an exchange stiffness is wanted here: J/m or erg/cm, with SI prefixes"#,
    }
    refuses! { Magnetisation:
        8e5 => r#"found the number 800000, but a magnetisation needs its unit: write "800000 A/m" (A/m or emu/cm^3, with SI prefixes)"#,
        "1.61 T" => r#""1.61 T" is a magnetic field, but a magnetisation is wanted here: A/m or emu/cm^3, with SI prefixes; if it is μ₀M, write "1.281197e6 A/m""#,
        "16.1 kG" => r#""16.1 kG" is a magnetic field, but a magnetisation is wanted here: A/m or emu/cm^3, with SI prefixes; if it is μ₀M, write "1.281197e6 A/m""#,
        "800 Ka/m" => r#"unknown unit "Ka" in "800 Ka/m": did you mean "kA"? (A/m or emu/cm^3, with SI prefixes)"#,
        "800 kA" => r#""800 kA" is an electric current, but a magnetisation is wanted here: A/m or emu/cm^3, with SI prefixes"#,
    }
    refuses! { Length:
        0.25 => r#"found the number 0.25, but a length needs its unit: write "0.25 nm" (m with SI prefixes, or angstrom)"#,
        "2.7 A" => r#""2.7 A" is an electric current, but a length is wanted here: m with SI prefixes, or angstrom (A is the ampere)"#,
        "2.7 Ang" => r#"unknown unit "Ang" in "2.7 Ang": did you mean "angstrom"? (m with SI prefixes, or angstrom)"#,
        "2.7 NM" => r#"unknown unit "NM" in "2.7 NM": did you mean "nm"? (m with SI prefixes, or angstrom)"#,
        "2.7 microns" => r#"unknown unit "microns" in "2.7 microns": a length is wanted here: m with SI prefixes, or angstrom"#,
        "2.7 angstroms" => r#"unknown unit "angstroms" in "2.7 angstroms": did you mean "angstrom"? (m with SI prefixes, or angstrom)"#,
        "2.7 deg" => r#""2.7 deg" is an angle, but a length is wanted here: m with SI prefixes, or angstrom"#,
    }
    refuses! { Temperature:
        300 => r#"found the number 300, but a temperature needs its unit: write "300 K" (K, with SI prefixes)"#,
        "300 k" => r#"unknown unit "k" in "300 k": did you mean "K"? (K, with SI prefixes)"#,
        "20 °C" => r#"unknown unit "°C" in "20 °C": a temperature is wanted here: K, with SI prefixes"#,
        "20 C" => r#"unknown unit "C" in "20 C": a temperature is wanted here: K, with SI prefixes"#,
        "300 kelvins" => r#"unknown unit "kelvins" in "300 kelvins": a temperature is wanted here: K, with SI prefixes"#,
    }
    refuses! { Time:
        1 => r#"found the number 1, but a time needs its unit: write "1 ps" (s, with SI prefixes)"#,
        "1 sec" => r#"unknown unit "sec" in "1 sec": did you mean "s"? (s, with SI prefixes)"#,
        "1 min" => r#"unknown unit "min" in "1 min": a time is wanted here: s, with SI prefixes"#,
        "1 PS" => r#"unknown unit "PS" in "1 PS": did you mean "ps"? (s, with SI prefixes)"#,
    }
    refuses! { Angle:
        1 => r#"found the number 1, but an angle needs its unit: write "1 deg" or "1 rad" (deg or rad, with SI prefixes)"#,
        "1 degrees" => r#"unknown unit "degrees" in "1 degrees": did you mean "deg"? (deg or rad, with SI prefixes)"#,
        "1 Rad" => r#"unknown unit "Rad" in "1 Rad": did you mean "rad"? (deg or rad, with SI prefixes)"#,
        "1" => r#""1" has no unit, but an angle needs one: write "1 deg" or "1 rad" (deg or rad, with SI prefixes)"#,
    }
}
