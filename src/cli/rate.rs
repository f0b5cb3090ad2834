//! `rate`: lifetimes of results that are there already.

use super::run::{Earlier, Progress, names, outcome, start_threads, write};
use super::{Rate, UNFINISHED, USAGE, note, report, worse};
use anyhow::Result;
use serde_json::json;
use spinneb::config::{RatesConfig, load};
use spinneb::drive::Outcome;
use spinneb::output::{Lock, folder};
use spinneb::rates::{Row, Theory, Way};
use std::f64::consts::LN_10;
use std::io::{self, Write};
use std::path::Path;
use std::time::Instant;

/// Rates of all results, one after the other.
pub fn rate(arguments: &Rate) -> Result<u8> {
    start_threads(arguments.threads)?;
    let mut code = 0;
    for directory in &arguments.results {
        code = worse(code, rate_one(arguments, directory).unwrap_or_else(|error| report(&error)));
    }
    Ok(code)
}

fn rate_one(arguments: &Rate, directory: &Path) -> Result<u8> {
    let started = Instant::now();
    let place = directory.display();
    let Some(stored) = folder::stored_result(directory, |_| true)? else {
        note(&format!("error: {place} holds no finished result: run its config first, then ask for its rates"));
        return Ok(USAGE);
    };
    let mut loaded = load(&directory.join("config.json"), &[])?;
    if loaded.sha256 != stored.config_sha256 {
        note(&format!("error: {place}: config.json is not the config of summary.json: run it anew"));
        return Ok(USAGE);
    }
    let Some(manifest) = stored.manifest else {
        let words = "has no manifest of its files, so none of them is replaced: run its config anew";
        note(&format!("error: {place}: the result of version {} {words}", stored.version));
        return Ok(USAGE);
    };
    folder::are_free(directory, &names(&loaded))?;
    let _lock = Lock::of(directory)?;
    loaded.config.rates = Some(asked(arguments));
    let problem = loaded.problem()?;
    let name = &loaded.name;
    if !arguments.quiet {
        note(&format!("{name}: the result holds no saddles to all digits; they are found anew from its config"));
    }
    let outcome = outcome(&loaded, &problem, &mut Progress::new(name, arguments.quiet), started)?;
    write(&loaded, &outcome, directory, Earlier::GivesWay(manifest.source.as_deref()), false)?;
    if !arguments.quiet {
        outcome.warnings.iter().for_each(|warning| note(&format!("{name}: warning: {warning}")));
        note(&format!(
            "{name}: rates are in {place}: summary.json, and rates.csv and arrhenius.svg and .png where asked for"
        ));
    }
    print(arguments, name, directory, &outcome)
}

/// The `rates` that the command line stands for.
fn asked(arguments: &Rate) -> RatesConfig {
    let mut config = RatesConfig::at(arguments.temperature.clone());
    (config.damping, config.g_factor) = (arguments.damping, arguments.g_factor);
    if !arguments.theory.is_empty() {
        config.theory = Theory::ALL.into_iter().filter(|t| arguments.theory.contains(t)).collect();
    }
    config
}

/// A table or a line of JSON; the exit code: 0 if every transition has a rate.
fn print(arguments: &Rate, name: &str, directory: &Path, outcome: &Outcome) -> Result<u8> {
    let mut out = io::stdout().lock();
    let transitions = outcome.rates.as_ref().map(|r| &r.transitions[..]).unwrap_or_default();
    let complete = !transitions.is_empty() && transitions.iter().all(|t| t.refused.is_none());
    let code = if complete && outcome.converged && outcome.certified { 0 } else { UNFINISHED };
    if arguments.json {
        let row = |r: &Row| {
            let rate = |ln: Option<f64>| ln.map(f64::exp);
            json!({
                "temperature_K": r.temperature_k,
                "htst_rate_per_s": rate(r.ln_htst_per_s),
                "langer_rate_per_s": rate(r.ln_langer_per_s),
                "log10_lifetime_s": r.ln_lifetime_s().map(|ln| ln / LN_10),
            })
        };
        let rows = |way: Way| -> Vec<serde_json::Value> {
            transitions.iter().filter(|t| t.way == way).flat_map(|t| t.rows.iter().map(row)).collect()
        };
        let line = json!({
            "name": name,
            "forward": rows(Way::Forward),
            "backward": rows(Way::Backward),
            "exit_code": code,
            "directory": directory.to_string_lossy(),
        });
        writeln!(out, "{line}")?;
        return Ok(code);
    }
    writeln!(
        out,
        "{name}: {:>9} {:>10} {:>14} {:>14} {:>14}",
        "direction", "T (K)", "HTST (1/s)", "Langer (1/s)", "lifetime (s)"
    )?;
    for t in transitions {
        let width = name.len() + 1;
        for r in &t.rows {
            let [htst, langer] = [r.ln_htst_per_s, r.ln_langer_per_s].map(power);
            let lifetime = power(r.ln_lifetime_s());
            let way = t.way.name();
            writeln!(out, "{:width$} {way:>9} {:>10} {htst:>14} {langer:>14} {lifetime:>14}", "", r.temperature_k)?;
        }
        if let Some(reason) = &t.refused {
            writeln!(out, "{:width$} {:>9} none: {reason}", "", t.way.name())?;
        }
    }
    out.flush()?;
    Ok(code)
}

/// e^ln in decimal, whatever its size.
fn power(ln: Option<f64>) -> String {
    let Some(ln) = ln else { return "-".into() };
    let log10 = ln / LN_10;
    let exponent = log10.floor();
    format!("{:.3}e{exponent}", libm::exp((log10 - exponent) * LN_10))
}

/// The lifetimes of the initial state at the coldest and the hottest temperature, in a line; nothing where there is none.
pub fn lifetimes(outcome: &Outcome) -> Option<String> {
    let transition = outcome.rates.as_ref()?.transitions.iter().find(|t| t.way == Way::Forward)?;
    let known = || transition.rows.iter().filter(|r| r.ln_lifetime_s().is_some());
    let coldest = known().min_by(|a, b| a.temperature_k.total_cmp(&b.temperature_k))?;
    let hottest = known().max_by(|a, b| a.temperature_k.total_cmp(&b.temperature_k))?;
    let at = |r: &Row| format!("{} s at {} K", power(r.ln_lifetime_s()), r.temperature_k);
    let both = if coldest == hottest { at(coldest) } else { format!("{}, {}", at(coldest), at(hottest)) };
    Some(format!("mean lifetime of the initial state: {both}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_any_size_are_shown() {
        assert_eq!(power(Some(5000.0 * LN_10 + LN_10 * 0.5)), "3.162e5000");
        assert_eq!(power(Some(-LN_10)), "1.000e-1");
        assert_eq!(power(None), "-");
    }
}
