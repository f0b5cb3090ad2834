//! `landscape.graphml`: minima as nodes, saddles as edges, as networkx, Gephi and yEd read it; where one state stands for all its
//! places by translations, with their number.

use super::LandscapeReport;
use crate::error::Result;
use std::fmt::Write;

const HEAD: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<graphml xmlns="http://graphml.graphdrawing.org/xmlns">
  <key id="kind" for="node" attr.name="kind" attr.type="int"/>
  <key id="energy" for="node" attr.name="above_lowest_meV" attr.type="double"/>
  <key id="saddle" for="edge" attr.name="saddle" attr.type="int"/>
  <key id="saddle_kind" for="edge" attr.name="kind" attr.type="int"/>
  <key id="height" for="edge" attr.name="above_lowest_meV" attr.type="double"/>
"#;

const PLACES: &str = r#"  <key id="places" for="all" attr.name="places" attr.type="int"/>
"#;

const GRAPH: &str = "  <graph edgedefault=\"undirected\">\n";

pub(super) fn render(report: &LandscapeReport) -> Result<Vec<u8>> {
    let s = report.survey;
    let mut text = HEAD.to_string() + if s.has_places() { PLACES } else { "" } + GRAPH;
    let places = |count: usize| match s.has_places() {
        true => format!(r#"<data key="places">{count}</data>"#),
        false => String::new(),
    };
    for (k, minimum) in s.minima.iter().enumerate() {
        let (kind, e) = (minimum.kind, s.minimum_kind(k).above_lowest_mev);
        let data = format!(r#"<data key="kind">{kind}</data><data key="energy">{e:?}</data>"#)
            + &places(s.minimum_kind(k).places);
        // writing into a string cannot fail
        let _ = writeln!(text, r#"    <node id="{k}">{data}</node>"#);
    }
    for (k, saddle) in s.saddles.iter().enumerate() {
        let ([a, b], kind, e) = (saddle.minima, saddle.kind, s.saddle_kind(k).above_lowest_mev);
        let data = format!(
            r#"<data key="saddle">{k}</data><data key="saddle_kind">{kind}</data><data key="height">{e:?}</data>"#
        ) + &places(s.saddle_kind(k).places);
        let _ = writeln!(text, r#"    <edge id="s{k}" source="{a}" target="{b}">{data}</edge>"#);
    }
    text += "  </graph>\n</graphml>\n";
    Ok(text.into_bytes())
}
