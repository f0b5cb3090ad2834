// The result in words and tables. Everything from the run enters as text, never as markup.

const MEANING = {
  yes: "No torque remains at the ends and saddles but for rounding; both ends are minima; each saddle has exactly one descending " +
    "direction; and the descents from the saddles lead from the initial to the final state without a gap. (An end that was kept as " +
    "given, relax_ends false, is exempt; a warning says so.) This proves the path, not that no lower one exists.",
  no: "Something of the proof is missing, and the warnings say what: take the barrier for an estimate. Certified would mean: no torque " +
    "at the ends and saddles, both ends minima, one descending direction at each saddle, and descents that lead from end to end.",
};

function card(title, big, ...small) {
  return make("div", { class: "panel card" }, make("div", { class: "title" }, title), make("div", { class: "big" }, big),
    ...small.map(line => make("div", { class: "small" }, line)));
}

/** The barrier and the verdict. What is not certified is called so beside its number, which has the digits that are known. */
function answer({ summary, barrier_told: told, moved }) {
  const { barrier_meV: mev, barrier_J: joule, barrier_K: kelvin, certified, converged } = summary;
  const barrier = (title, way) => {
    if (!mev) return card(title, "none", "see the stop reason");
    if (told) return card(title, told[way][0], "not certified", ...told[way].slice(1));
    return card(title, `${number(mev[way], 10)} meV`, `${number(joule[way], 7)} J`, `${number(kelvin[way], 7)} K (E/k_B)`);
  };
  const verdict = card("Verdict", certified ? "Certified" : "Not certified", summary.stop_reason, ...moved);
  verdict.classList.add("verdict");
  verdict.classList.toggle("no", !(certified && converged) || moved.length > 0);
  const words = make("details", {}, make("summary", {}, "What this means"), make("p", {}, certified ? MEANING.yes : MEANING.no));
  verdict.append(words);
  $("answer").append(barrier("Barrier forward (initial → final)", "forward"), barrier("Barrier backward (final → initial)", "backward"), verdict);
}

/** A table from a list of headings and rows of cells; a cell is text or an element. */
function table(caption, headings, rows, words = []) {
  const mark = k => (words.includes(k) ? { class: "words" } : {});
  const head = make("tr", {}, ...headings.map((heading, k) => make("th", { scope: "col", ...mark(k) }, heading)));
  const body = rows.map(cells => make("tr", {}, ...cells.map((cell, k) => make("td", mark(k), cell))));
  const whole = make("table", {}, make("caption", {}, caption), make("thead", {}, head), make("tbody", {}, ...body));
  return make("div", { class: "scroll", tabindex: "0", role: "region", "aria-label": caption }, whole);
}

function section(title, ...content) {
  const id = `part-${title.toLowerCase().replace(/[^a-z]+/g, "-")}`;
  const whole = make("section", { class: "panel", "aria-labelledby": id }, make("h2", { id }, title), ...content);
  $("summary").append(whole);
  return whole;
}

const count = n => (n === null || n === undefined ? "not counted" : String(n));
const list = lines => make("ul", {}, ...lines.map(line => make("li", {}, line)));
const plural = (n, word) => `${n} ${word}${n === 1 ? "" : "s"}`;

/** All that is below the pictures. `go` moves the picture to a place of the path. */
function tell(path, go) {
  const { data } = path, { summary } = data;
  if (summary.warnings.length) section("Warnings", list(summary.warnings));
  stationary(path, go);
  if (summary.transition_rates) rates(summary);
  if (summary.rejected_paths.length) rejected(summary);
  energies(path);
  spins(path);
  provenance(data);
}

function stationary(path, go) {
  const row = stop => {
    const button = make("button", { type: "button", "aria-label": `Show ${stop.name}` }, "Show");
    button.onclick = () => go(stop.s);
    const { image, negative_modes, zero_modes, lowest_eigenvalues_meV: modes, max_torque_meV } = stop.state;
    const at = image ?? (stop.s > 0 ? path.data.images - 1 : 0);
    return [stop.name, number(stop.energy, 8), number(stop.s, 6), String(at), count(negative_modes), count(zero_modes),
      (modes ?? []).slice(0, 4).map(e => number(e, 4)).join(", ") || "–", number(max_torque_meV, 2), button];
  };
  const headings = ["State", "Above initial (meV)", "At (rad)", "Image", "Descending modes", "Zero modes", "Lowest eigenvalues (meV)", "Torque left (meV)", ""];
  const caption = "In path order. A minimum has no descending mode, a saddle of first order exactly one.";
  section("Minima and saddles", table(caption, headings, path.stops.map(row)));
}

/** 10 to a power, in digits. */
function power(log10, digits) {
  const whole = Math.floor(log10);
  return Math.abs(log10) < 300 ? number(10 ** log10, digits) : `${number(10 ** (log10 - whole), digits)} × 10^${whole}`;
}

/** How many digits of a rate or a time are known. */
const shown = t => (t.known_within_factor ? clamp(Math.ceil(-Math.log10(Math.max(t.known_within_factor - 1, 1e-12))), 1, 4) : 1);

/** A time of which the logarithm is given. */
const time = (t, key) => (t[`log10_${key}`] === null ? "–" : power(t[`log10_${key}`], shown(t)));

function rates(summary) {
  // grey where the barrier is below 5 k_BT
  const rough = (t, text) => (t.barrier_over_kT < 5 ? make("span", { class: "rough" }, text) : text);
  const range = t => (t.known_within_factor ? `× or ÷ ${number(t.known_within_factor, 2)}` : (t.reason ?? "–"));
  const row = (head, t) => [...head, ...[number(t.temperature_K, 5), number(t.barrier_over_kT, 4), number(t.htst_rate_per_s, shown(t)),
    number(t.langer_rate_per_s, shown(t)), time(t, "escape_lifetime_s"), time(t, "first_passage_s"), range(t)].map(text => rough(t, text))];
  const headings = ["Direction", "T (K)", "ΔE/k_BT", "HTST (1/s)", "Langer (1/s)", "Escape from the first minimum (s)", "First passage (s)", "Known within"];
  const whole = summary.transition_rates.flatMap(t => t.temperatures.map(temperature => row([t.direction], temperature)));
  const caption = "The whole path, over all minima on the way: mean times, and rates of the first passage to the other end; grey below 5 k_BT";
  const content = [table(caption, headings, whole, [7])];
  for (const t of summary.transition_rates) {
    if (t.refused) content.push(make("p", {}, `No rate ${t.direction}: ${t.refused}`));
    if (t.blocking_temperature_1_s_K) {
      content.push(make("p", {}, `${t.direction}: a first passage of 1 s at ${number(t.blocking_temperature_1_s_K, 4)} K, of ten years at ` +
        `${number(t.blocking_temperature_10_years_K, 4)} K; ${plural(t.saddles, "saddle")}, ${plural(t.equivalent_paths, "equivalent path")}.`));
    }
  }
  const groups = [];
  const prefactors = (summary.rates ?? []).map(r => {
    const group = r.warnings_as ?? groups.push(r.warnings) - 1;
    const words = [...Object.entries(r.refused).map(([theory, reason]) => `no ${theory}: ${reason}`), groups[group].length ? `see ${group + 1}` : "–"];
    return [`Saddle ${r.saddle} ${r.direction}`, number(r.barrier_meV, 7), number(r.htst_prefactor_Hz, 4), number(r.langer_prefactor_Hz, 4),
      number(r.crossover_temperature_K, 3), String(r.equivalent_saddles), words.join("; ")];
  });
  const names = ["Saddle", "ΔE (meV)", "HTST prefactor (Hz)", "Langer prefactor (Hz)", "Tunnelling below (K)", "Equivalents", "Warnings"];
  const warnings = groups.flatMap((lines, k) => (lines.length ? [make("h3", {}, `Warnings ${k + 1}`), list(lines)] : []));
  const inner = table("Prefactors at the first temperature; warnings that are alike are told once", names, prefactors, [6]);
  content.push(make("details", {}, make("summary", {}, "Each saddle"), inner, ...warnings));
  section("Rates and lifetimes", ...content);
}

function rejected(summary) {
  const rows = summary.rejected_paths.map(p => [p.guess, number(p.barrier_meV, 7), count(p.negative_modes), p.reason]);
  const headings = ["First path", "Barrier (meV)", "Descending modes", "Why it was left"];
  section("Paths tried and left", table("Other first paths, as far as they were followed", headings, rows, [3]));
}

function energies(path) {
  const rows = path.images.map((image, k) => [String(image), number(path.at[k], 6), number(path.energy[k], 6),
    ...path.terms.map(term => number(term.energy[k], 6)), number(path.torque[k], 2), ...(path.charge ? [number(path.charge[k], 4)] : [])]);
  const headings = ["Image", "Reaction coordinate (rad)", "Above initial (meV)", ...path.terms.map(term => `${term.name} (meV)`), "Torque across the path (meV)", ...(path.charge ? ["Charge"] : [])];
  const caption = "Energies above those of the initial state";
  section("The profile as a table", make("details", {}, make("summary", {}, plural(rows.length, "image")), table(caption, headings, rows)));
}

/** Rows of that table at most: more would hold a browser up. */
const MOST_ROWS = 2000;

/** The spins where the picture is, as a table; it is made when it is opened, and again when the picture comes to rest. */
function spins(path) {
  const place = make("div");
  const details = make("details", { id: "spins-table" }, make("summary", {}, "The spins that the picture shows"), place);
  details.ontoggle = () => details.dispatchEvent(new Event("rest"));
  details.addEventListener("rest", () => {
    if (!details.open || !path.spins) return;
    const s = Number(details.dataset.s), m = new Float32Array(3 * path.sites.length);
    path.spinsAt(s, m);
    const degrees = radians => number(Number(((radians * 180) / Math.PI).toFixed(1)), 4);
    const [vacant, frozen] = [path.data.vacant, path.data.frozen].map(list => new Set(list));
    const rows = path.sites.slice(0, MOST_ROWS).map((site, k) => {
      const [x, y, z] = m.subarray(3 * k, 3 * k + 3);
      const three = [x, y, z].map(c => number(Number(c.toFixed(3)), 4));
      const note = [vacant.has(site) ? "vacant" : "", frozen.has(site) ? "frozen" : ""].filter(Boolean).join(", ");
      return [String(site), ...three, degrees(Math.acos(clamp(z, -1, 1))), degrees(Math.atan2(y, x)), note];
    });
    const first = path.sites.length > MOST_ROWS ? `, the first ${MOST_ROWS} sites of ${path.sites.length}` : "";
    const caption = `At ${number(s, 6)} rad${first}; polar angle from +z, azimuth from +x towards +y`;
    place.replaceChildren(table(caption, ["Site", "m_x", "m_y", "m_z", "Polar (°)", "Azimuth (°)", ""], rows));
  });
  section("The spins as a table", details);
}

function provenance(data) {
  const { summary } = data, entries = [];
  const entry = (name, value) => value && entries.push(make("dt", {}, name), make("dd", {}, value));
  entry("Program", `spinneb ${summary.version}`);
  entry("SHA-256 of the config", summary.config_sha256);
  entry("Material", data.material.name);
  entry("Source of the material", data.material.source);
  entry("Band", `${plural(summary.path.images, "image")}, length ${number(summary.path.length_rad, 7)} rad, largest torque across the path ` +
    `${number(summary.path.max_perpendicular_torque_meV, 2)} meV, still turning by ${number(summary.path.largest_predicted_rotation_rad, 2)} rad`);
  entry("Work", `${plural(summary.work.iterations, "iteration")} of the band, ${plural(summary.work.force_evaluations, "gradient")} of one image`);
  entry("Ends", `initial ${number(summary.initial.energy_meV, 12)} meV, final ${number(summary.final.energy_meV, 12)} meV`);
  const config = data.config === null
    ? make("p", {}, "The config is long; it is config.json beside this page.")
    : make("details", {}, make("summary", {}, "The config as run"), make("pre", { tabindex: "0" }, data.config));
  section("Where this comes from", make("dl", {}, ...entries), config);
}
