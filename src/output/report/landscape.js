// A landscape: the network that one clicks, and the spins of the state that was clicked.

/** The states as images of a path that one jumps along. */
class States {
  constructor(data) {
    this.data = data;
    this.sites = data.sites_shown;
    this.places = data.lattice && column(data.lattice.places);
    this.length = data.images - 1;
  }

  async unpack() {
    const { packed, scale } = this.data.spins;
    this.spins = await spinsOf(packed, this.data.images, this.sites.length, scale);
  }

  /** Writes the spins of an image into `out`, three numbers a site. */
  spinsAt(image, out) {
    const n = 3 * this.sites.length;
    out.set(this.spins.subarray(image * n, (image + 1) * n));
  }
}

const data = JSON.parse($("data").textContent);
const path = new States(data);
const page = { s: 0, view: null, chart: null, state: null };

const above = (state, kinds) => `${number(kinds[state.kind].above_lowest_meV, 6)} meV`;

/** "Minimum 3": of which kind, how high, and what it is beside. */
function told(state) {
  const kinds = state.saddle ? data.saddle_kinds : data.minimum_kinds;
  const { multiplicity, first } = kinds[state.kind];
  const words = [`${state.name}, ${above(state, kinds)} above the lowest minimum`, `kind ${state.kind}${multiplicity > 1 ? `, one of ${multiplicity} that symmetry makes alike` : ""}`];
  if (state.saddle) {
    const climbs = state.minima.map(k => `${number(kinds[state.kind].above_lowest_meV - data.minimum_kinds[minima[k].kind].above_lowest_meV, 6)} meV above minimum ${k}`);
    words.push(state.minima[0] === state.minima[1] ? climbs[0] : climbs.join(", "));
  }
  if (!data.all_shown && state.number !== first) words.push(`shown: the first of its kind, ${state.saddle ? "saddle" : "minimum"} ${first}`);
  return words.join("; ");
}

const minima = data.minima.map((minimum, k) => ({ ...minimum, number: k, saddle: false, name: `Minimum ${k}` }));
const saddles = data.saddles.map((saddle, k) => ({ ...saddle, number: k, saddle: true, name: `Saddle ${k}` }));

/** Shows a state: its spins, its place in the network, and what it is joined with. */
function choose(state) {
  page.state = state;
  page.s = state.image;
  page.view?.show(state.image);
  page.chart.choose(state);
  $("where").textContent = told(state);
  $("live").textContent = told(state);
  const beside = state.saddle ? [...new Set(state.minima)].map(k => minima[k]) : saddles.filter(saddle => saddle.minima.includes(state.number)).slice(0, 60);
  $("beside").replaceChildren(...beside.map(other => {
    const way = other.saddle && other.minima[0] !== other.minima[1] ? ` to ${other.minima.find(k => k !== state.number)}` : "";
    const button = make("button", { type: "button" }, other.name + way);
    button.onclick = () => choose(other);
    return button;
  }));
  $("spins-table").dataset.state = state.name;
  $("spins-table").dispatchEvent(new Event("rest"));
}

/** Minima as discs, saddles as arcs. */
class Network {
  constructor() {
    this.svg = document.querySelector("#network svg");
    this.things = new Map();
    const speaks = data.minima.length + data.saddles.length <= 300;
    const thing = (state, ...shapes) => {
      const group = draw(this.svg, "g", speaks ? { role: "button", tabindex: "0", "aria-label": told(state) } : {});
      draw(group, "title", {}, told(state));
      const drawn = shapes.map(([tag, attributes, text]) => draw(group, tag, attributes, text));
      group.onclick = () => choose(state);
      group.onkeydown = event => {
        if (event.key !== "Enter" && event.key !== " ") return;
        choose(state);
        event.preventDefault();
      };
      this.things.set(state, { group, drawn });
    };
    for (const saddle of saddles.filter(saddle => saddle.bend).sort((a, b) => b.number - a.number)) {
      thing(saddle, ["path", { class: "halo" }], ["path", { class: "arc", stroke: data.colours[saddle.colour] }], ["path", { class: "reach" }]);
    }
    this.numbered = data.minima.length <= 80;
    for (const minimum of minima.filter(minimum => minimum.place).reverse()) {
      thing(minimum, ["circle", { fill: data.colours[minimum.colour] }], ...(this.numbered ? [["text", {}, String(minimum.number)]] : []));
    }
    new ResizeObserver(() => this.render()).observe($("network"));
  }

  /** To pixels, alike in both directions. */
  render() {
    const { clientWidth: width, clientHeight: height } = $("network");
    const points = [...minima.filter(m => m.place).map(m => m.place), ...saddles.filter(s => s.bend).map(s => s.bend)];
    if (!points.length || !width) return;
    const [low, high] = [Math.min, Math.max].map(of => [0, 1].map(c => points.reduce((x, p) => of(x, p[c]), points[0][c])));
    // a long network lies along the longer side
    const upright = (height > width) !== (high[1] - low[1] > high[0] - low[0]) && high[0] - low[0] > 0;
    const turn = p => (upright ? [p[1], p[0]] : p);
    const [from, to] = [turn(low), turn(high)];
    const radius = this.numbered ? clamp(0.2 * Math.sqrt((width * height) / points.length), 8, 12) : 5;
    const room = radius + 8;
    const scale = Math.min((width - 2 * room) / Math.max(to[0] - from[0], 1e-9), (height - 2 * room) / Math.max(to[1] - from[1], 1e-9), 160);
    const at = p => turn(p).map((x, c) => (c ? height : width) / 2 + (c ? -1 : 1) * scale * (x - (from[c] + to[c]) / 2));
    this.svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
    for (const [state, { drawn }] of this.things) {
      if (state.saddle) {
        const [a, b] = state.minima.map(k => at(minima[k].place)), c = at(state.bend);
        for (const shape of drawn) shape.setAttribute("d", `M${a} Q${c} ${b}`);
      } else {
        const [x, y] = at(state.place);
        for (const [name, value] of [["cx", x], ["cy", y], ["r", radius]]) drawn[0].setAttribute(name, value);
        drawn[1]?.setAttribute("x", x);
        drawn[1]?.setAttribute("y", y + 4);
      }
    }
  }

  choose(state) {
    this.svg.querySelector(".chosen")?.classList.remove("chosen");
    this.things.get(state)?.group.classList.add("chosen");
  }
}

function lifetimes() {
  const range = l => (l.known_within_factor ? `× or ÷ ${number(l.known_within_factor, 2)}` : "–");
  const why = data.lifetimes.some(l => l.reason) ? ["Why there is none"] : [];
  const rows = data.lifetimes.map(l => [l.from, l.to ?? "anywhere", number(l.temperature_K, 5), number(l.climb_meV, 6), time(l, "htst_time_s"), time(l, "langer_time_s"), range(l), ...why.map(() => l.reason ?? "–")]);
  const headings = ["From", "To", "T (K)", "Climb (meV)", "HTST (s)", "Langer (s)", "Known within", ...why];
  section("Lifetimes", table("Mean times over the whole network, minima between counted; \"anywhere\": until the group is left", headings, rows, [7]));
}

function kinds(title, list, states, word) {
  const rows = list.map((kind, k) => {
    const button = make("button", { type: "button", "aria-label": `Show ${word} ${kind.first}` }, "Show");
    button.onclick = () => choose(states[kind.first]);
    const ends = kind.minima ? [kind.minima.join(" – ")] : [];
    return [String(k), ...ends, number(kind.above_lowest_meV, 9), String(kind.multiplicity), String(kind.negative_modes), String(kind.zero_modes), number(kind.max_torque_meV, 2), button];
  });
  const between = list[0]?.minima ? ["Between kinds"] : [];
  const headings = ["Kind", ...between, "Above the lowest (meV)", "Alike by symmetry", "Descending modes", "Zero modes", "Torque left (meV)", ""];
  section(title, table("One entry for all states that symmetry makes of one", headings, rows));
}

/** The spins of the state that is shown, made when the table is opened. */
function spinsTable() {
  const place = make("div");
  const details = make("details", { id: "spins-table" }, make("summary", {}, "The spins that the picture shows"), place);
  details.ontoggle = () => details.dispatchEvent(new Event("rest"));
  details.addEventListener("rest", () => {
    if (!details.open || !path.spins) return;
    const m = new Float32Array(3 * path.sites.length);
    path.spinsAt(page.s, m);
    const rows = path.sites.slice(0, MOST_ROWS).map((site, k) => [String(site), ...[0, 1, 2].map(c => number(Number(m[3 * k + c].toFixed(3)), 4))]);
    place.replaceChildren(table(details.dataset.state ?? "", ["Site", "m_x", "m_y", "m_z"], rows));
  });
  section("The spins as a table", details);
}

function begin() {
  const { summary, warnings } = data;
  $("subject").textContent = [data.material.name, data.words, `spinneb ${summary.version}`].filter(Boolean).join(" · ");
  const many = (states, list, word) => card(word, String(states.length), `of ${plural(list.length, "kind")} that symmetry does not make alike`);
  const verdict = card("Search", data.finished ? "Came to its stop" : "Ended before its stop", data.stop_reason, "No number of searches proves that all was found.");
  verdict.classList.add("verdict");
  verdict.classList.toggle("no", !data.finished);
  $("answer").append(many(data.minima, data.minimum_kinds, "Minima"), many(data.saddles, data.saddle_kinds, "Saddles"), verdict);
  if (warnings.length) section("Warnings", list(warnings));
  if (data.lifetimes?.length) lifetimes();
  kinds("Kinds of minima", data.minimum_kinds, minima, "minimum");
  if (data.saddle_kinds.length) kinds("Kinds of saddles", data.saddle_kinds, saddles, "saddle");
  spinsTable();
  const config = data.config === null ? make("p", {}, "The config is long; it is config.json beside this page.")
    : make("details", {}, make("summary", {}, "The config as run"), make("pre", { tabindex: "0" }, data.config));
  section("Where this comes from", make("dl", {}, make("dt", {}, "SHA-256 of the config"), make("dd", {}, summary.config_sha256)), config);
  const notes = [];
  const drawn = minima.filter(minimum => minimum.place).length;
  if (drawn < minima.length) notes.push(`Of ${minima.length} minima the ${drawn} lowest are drawn.`);
  if (!data.all_shown) notes.push("There are too many states for one page: the spins are those of the first of each kind.");
  if (path.sites.length < data.sites) notes.push(`Of ${data.sites} sites ${path.sites.length} are drawn, evenly spaced.`);
  notes.push("Click a disc (a minimum) or a line (a saddle) for its spins; saddles that lead back to where they began are in the tables alone.");
  $("notes").textContent = notes.join(" ");
  $("bar").style.background = `linear-gradient(90deg, ${data.colours.join(", ")})`;
  $("top").textContent = `${number(data.top_meV, 4)} meV`;
  $("theme").onchange = () => {
    document.documentElement.dataset.theme = $("theme").value;
    page.view?.refresh();
  };
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => page.view?.refresh());
}

async function picture() {
  begin();
  page.chart = new Network();
  if (!minima.length) {
    document.querySelector(".view").hidden = true;
    return;
  }
  await path.unpack();
  page.view = new View(path, () => {});
  wireView(page.view);
  $("view").setAttribute("aria-label", `The spins of the state that is chosen, in three dimensions: ${plural(path.sites.length, "spin")}`);
  choose(minima[0]);
}

picture().catch(error => {
  $("problem").textContent = `The pictures cannot be drawn here (${error.message}). The numbers below are complete; a browser of 2024 or later shows all.`;
  $("problem").hidden = false;
  throw error;
});
