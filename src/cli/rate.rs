//! `rate`: lifetimes of results that are there already.

use super::progress::Progress;
use super::threads::start_threads;
use super::write::{Earlier, write};
use super::{Rate, UNFINISHED, USAGE, note, report, worse};
use crate::config::{Loaded, RatesConfig, load};
use crate::drive::{self, Outcome, Problem};
use crate::output::{Picture, StoredOutcome, folder};
use crate::rates::{Row, Theory, TransitionRate, TransitionRow, Way, digits};
use crate::record::Lock;
use anyhow::Result;
use serde_json::{Value, json};
use std::f64::consts::LN_10;
use std::io::{self, Write};
use std::path::Path;

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
    let place = directory.display();
    let Some(stored) = folder::stored_result(directory, |_| true)? else {
        note(&format!("error: {place} holds no finished result: run its config first, then ask for its rates"));
        return Ok(USAGE);
    };
    let mut loaded = load(&directory.join("config.json"), &[])?;
    if loaded.sha256 != stored.head.config_sha256 {
        note(&format!("error: {place}: config.json is not the config of summary.json: run it anew"));
        return Ok(USAGE);
    }
    let Some(manifest) = stored.manifest else {
        let words = "has no manifest of its files, so none of them is replaced: run its config anew";
        note(&format!("error: {place}: the result of version {} {words}", stored.head.version));
        return Ok(USAGE);
    };
    folder::are_free(directory, &loaded.file_names())?;
    let _lock = Lock::of(directory)?;
    loaded.config.rates = Some(asked(arguments, loaded.config.rates.take()));
    let problem = loaded.problem()?;
    let name = &loaded.name;
    let outcome = match from_files(&loaded, &problem, directory)? {
        Ok(outcome) => outcome,
        Err(why) => {
            if !arguments.quiet {
                note(&format!("{name}: the saddles are found anew from its config: {why}"));
            }
            drive::run(&problem, &mut Progress::new(name, arguments.quiet))?
        }
    };
    write(&loaded, &outcome, directory, Earlier::GivesWay(manifest.source.as_deref()), false)?;
    if !arguments.quiet {
        outcome.warnings.iter().for_each(|warning| note(&format!("{name}: warning: {warning}")));
        if outcome.rates.is_some() {
            let is_there = |kind: Picture| directory.join("arrhenius").with_extension(kind.extension()).exists();
            let figure = match [Picture::Svg, Picture::Png].into_iter().any(is_there) {
                true => "the table and the figure that its config asks for",
                false => {
                    "the table that its config asks for; no figure, which takes a config that asks for it and times at two temperatures"
                }
            };
            note(&format!("{name}: rates are in {place}: summary.json, and {figure}"));
        }
    }
    print(arguments, name, directory, &outcome)
}

/// The outcome as stored, with the rates over its own saddles and minima; why it cannot be had that way, if so.
fn from_files(loaded: &Loaded, problem: &Problem, directory: &Path) -> Result<std::result::Result<Outcome, String>> {
    let StoredOutcome { outcome, minima } = match StoredOutcome::read(directory, problem.hamiltonian.lattice())? {
        Ok(stored) => stored,
        Err(why) => return Ok(Err(why)),
    };
    Ok(outcome.with_rates(problem, &minima, &loaded.warnings))
}

/// The `rates` that the command line stands for; what it leaves open is as in the config of the result.
fn asked(arguments: &Rate, earlier: Option<RatesConfig>) -> RatesConfig {
    let mut config = RatesConfig::at(arguments.temperature.clone());
    if let Some(earlier) = earlier {
        config = RatesConfig { temperatures: config.temperatures, ..earlier };
    }
    config.damping = arguments.damping.unwrap_or(config.damping);
    config.g_factor = arguments.g_factor.unwrap_or(config.g_factor);
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
    match arguments.json {
        true => writeln!(out, "{}", json_line(name, directory, transitions, code))?,
        false => table(&mut out, name, transitions)?,
    }
    out.flush()?;
    Ok(code)
}

fn json_line(name: &str, directory: &Path, transitions: &[TransitionRate], code: u8) -> Value {
    let row = |r: &TransitionRow| {
        let exp = |ln: Option<f64>| ln.map(f64::exp);
        let log10 = |r: &Row| r.ln_lifetime_s().map(|ln| ln / LN_10);
        json!({
            "temperature_K": r.passage.temperature_k,
            "htst_rate_per_s": exp(r.passage.ln_htst_per_s),
            "langer_rate_per_s": exp(r.passage.ln_langer_per_s),
            "log10_escape_lifetime_s": log10(&r.escape),
            "log10_first_passage_s": log10(&r.passage),
            "known_within_factor": r.passage.known_within,
        })
    };
    let rows = |way: Way| -> Vec<Value> {
        transitions.iter().filter(|t| t.way == way).flat_map(|t| t.rows.iter().map(row)).collect()
    };
    json!({
        "name": name,
        "forward": rows(Way::Forward),
        "backward": rows(Way::Backward),
        "exit_code": code,
        "directory": directory.to_string_lossy(),
    })
}

/// A row a temperature.
fn table(out: &mut impl Write, name: &str, transitions: &[TransitionRate]) -> io::Result<()> {
    writeln!(
        out,
        "{name}: {:>9} {:>10} {:>11} {:>11} {:>11} {:>17} {:>12}",
        "direction", "T (K)", "HTST (1/s)", "Langer (1/s)", "escape (s)", "first passage (s)", "known within"
    )?;
    for t in transitions {
        let (width, way) = (name.len() + 1, t.way.name());
        for TransitionRow { passage: r, escape } in &t.rows {
            if let Some(reason) = &r.reason {
                writeln!(out, "{:width$} {way:>9} {:>10} none: {reason}", "", r.temperature_k)?;
                continue;
            }
            let shown = digits(r.known_within);
            let [htst, langer, passage] =
                [r.ln_htst_per_s, r.ln_langer_per_s, r.ln_lifetime_s()].map(|ln| power(ln, shown));
            let escape = power(escape.ln_lifetime_s(), digits(escape.known_within));
            let within = r.known_within.map_or("-".into(), range);
            writeln!(
                out,
                "{:width$} {way:>9} {:>10} {htst:>11} {langer:>12} {escape:>11} {passage:>17} {within:>12}",
                "", r.temperature_k
            )?;
        }
        if let Some(reason) = &t.refused {
            writeln!(out, "{:width$} {way:>9} none: {reason}", "")?;
        }
        if t.rows.iter().any(|row| row.passage.known_within.is_some_and(is_vague)) {
            writeln!(out, "{:width$} {way:>9} within a factor above {VAGUE}: {VAGUE_WORDS}", "")?;
        }
    }
    Ok(())
}

/// e^ln in decimal with so many digits, whatever its size.
fn power(ln: Option<f64>, digits: usize) -> String {
    let Some(ln) = ln else { return "-".into() };
    let log10 = ln / LN_10;
    let exponent = log10.floor();
    let decimals = digits.saturating_sub(1);
    let mantissa = format!("{:.decimals$}", libm::exp((log10 - exponent) * LN_10));
    // rounded up to the next power
    match mantissa.strip_prefix("10") {
        Some(_) => format!("{:.decimals$}e{}", 1.0, exponent + 1.0),
        None => format!("{mantissa}e{exponent}"),
    }
}

/// What is known within more than this factor says little.
const VAGUE: f64 = 100.0;
const VAGUE_WORDS: &str = "not even its order of magnitude is known";

fn is_vague(factor: f64) -> bool {
    factor > VAGUE
}

/// A factor in a few digits.
fn range(factor: f64) -> String {
    match factor {
        f if f < 1.095 => format!("factor {f:.2}"),
        f if f < 9.95 => format!("factor {f:.1}"),
        f if f < 1e4 => format!("factor {f:.0}"),
        f => format!("factor {f:.0e}"),
    }
}

/// The same beside a time, in words where it says little.
fn within(factor: f64) -> String {
    let vague = if is_vague(factor) { format!(": {VAGUE_WORDS}") } else { String::new() };
    format!(" (within a {}{vague})", range(factor).replace("factor", "factor of"))
}

/// The mean times from the initial state at the coldest and the hottest temperature, in a line; nothing where there are none.
pub fn lifetimes(outcome: &Outcome) -> Option<String> {
    let transition = outcome.rates.as_ref()?.transitions.iter().find(|t| t.way == Way::Forward)?;
    let line = |pick: fn(&TransitionRow) -> &Row| -> Option<String> {
        let known = || transition.rows.iter().map(pick).filter(|r| r.ln_lifetime_s().is_some());
        let coldest = known().min_by(|a, b| a.temperature_k.total_cmp(&b.temperature_k))?;
        let hottest = known().max_by(|a, b| a.temperature_k.total_cmp(&b.temperature_k))?;
        let at = |r: &Row| {
            let within = r.known_within.map_or(String::new(), within);
            format!("{} s at {} K{within}", power(r.ln_lifetime_s(), digits(r.known_within)), r.temperature_k)
        };
        let one = coldest.temperature_k == hottest.temperature_k;
        Some(if one { at(coldest) } else { format!("{}, {}", at(coldest), at(hottest)) })
    };
    let passage = line(|r| &r.passage).map(|times| times + &without(transition));
    if transition.saddles == 1 {
        return passage.map(|passage| format!("mean lifetime of the initial state: {passage}"));
    }
    let passage = passage.map(|passage| format!("mean first passage to the final state: {passage}"));
    let escape = line(|r| &r.escape).map(|escape| format!("mean escape over the first saddle: {escape}"));
    let told: Vec<String> = passage.into_iter().chain(escape).collect();
    (!told.is_empty()).then(|| told.join("; "))
}

/// At which temperatures there is no time to the other end, beside those with one.
fn without(transition: &TransitionRate) -> String {
    let none = transition.rows.iter().filter(|row| row.passage.ln_lifetime_s().is_none());
    let kelvin: Vec<String> = none.map(|row| format!("{} K", row.passage.temperature_k)).collect();
    match &kelvin[..] {
        [] => String::new(),
        few if few.len() <= 3 => format!(", none at {}", few.join(", ")),
        many => format!(", none at {} of {} temperatures", many.len(), transition.rows.len()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_time_that_is_hardly_known_is_told_in_words() {
        assert_eq!(within(2.0), " (within a factor of 2.0)");
        assert_eq!(within(7e5), " (within a factor of 7e5: not even its order of magnitude is known)");
    }

    #[test]
    fn numbers_of_any_size_are_shown() {
        assert_eq!(power(Some(5000.0 * LN_10 + LN_10 * 0.5), 4), "3.162e5000");
        assert_eq!(power(Some(-LN_10), 2), "1.0e-1");
        assert_eq!(power(Some(9.7f64.ln()), 1), "1e1");
        assert_eq!(power(None, 3), "-");
    }
}
