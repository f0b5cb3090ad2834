// The energy profile and, under it and over the same reaction coordinate, the map of all spins of a chain or the topological charge of
// a film; a line through both shows where the picture is. A press anywhere goes there.

const ROOM = { left: 62, right: 14, top: 16, middle: 14, bottom: 42 };

class Chart {
  constructor(path, onPick) {
    Object.assign(this, { path, onPick, s: 0, scheme: "direction", chosen: new Set() });
    this.svg = document.querySelector("#chart svg");
    this.describe();
    this.offerTerms();
    new ResizeObserver(() => this.render()).observe($("chart"));
    this.listen();
  }

  describe() {
    const { path } = this;
    const words = path.stops.map(stop => `${stop.name.toLowerCase()} at ${number(stop.s, 4)} rad, ${number(stop.energy, 5)} meV`);
    const list = words.length > 12 ? [...words.slice(0, 6), `${words.length - 12} more`, ...words.slice(-6)] : words;
    $("chart-words").textContent =
      `Energy above the initial state against the reaction coordinate, and ${path.places ? "the topological charge" : "a map of the spins"}: ${list.join("; ")}. The tables below have the numbers.`;
  }

  offerTerms() {
    const { terms } = this.path;
    $("terms").hidden = terms.length === 0;
    terms.forEach((term, k) => {
      const box = make("input", { type: "checkbox", "data-term": k });
      box.onchange = () => {
        box.checked ? this.chosen.add(k) : this.chosen.delete(k);
        this.render();
      };
      const swatch = make("span", { class: "swatch", "aria-hidden": "true" });
      swatch.style.background = `var(--term-${k % 7})`;
      $("terms").append(make("label", {}, box, swatch, term.name));
    });
  }

  listen() {
    const pick = event => {
      const box = this.svg.getBoundingClientRect();
      this.onPick(clamp((event.clientX - box.left - ROOM.left) / (this.right - ROOM.left), 0, 1) * this.path.length);
    };
    this.svg.addEventListener("pointerdown", event => {
      if (event.button !== 0) return;
      this.svg.setPointerCapture(event.pointerId);
      pick(event);
    });
    this.svg.addEventListener("pointermove", event => {
      if (this.svg.hasPointerCapture(event.pointerId)) pick(event);
    });
  }

  /** All of it anew, for the room that there is. */
  render() {
    const { clientWidth: width, clientHeight: height } = $("chart");
    if (width < 80 || height < 80) return;
    const { svg, path } = this;
    [...svg.children].slice(1).forEach(child => child.remove());
    this.right = width - ROOM.right;
    const high = (height - ROOM.top - ROOM.bottom - ROOM.middle) * (this.hasLower() ? (path.places ? 0.72 : 0.6) : 1);
    this.upper = { top: ROOM.top, bottom: ROOM.top + high };
    this.lower = { top: this.upper.bottom + ROOM.middle, bottom: height - ROOM.bottom };
    this.range();
    this.drawAxes(width);
    this.drawCurves();
    if (this.hasLower()) path.places ? this.drawCharge() : this.drawMap();
    this.drawCursor();
    this.move(this.s);
  }

  /** Whether there is something below the profile. */
  hasLower() {
    return this.path.spins && (!this.path.places || this.path.charge);
  }

  x(s) {
    return ROOM.left + (this.path.length > 0 ? s / this.path.length : 0) * (this.right - ROOM.left);
  }

  y(mev) {
    const { top, bottom } = this.upper;
    return bottom - ((mev * this.unit.perMev - this.low) / (this.high - this.low)) * (bottom - top);
  }

  /** The energies to show, with room around them. */
  range() {
    const { path } = this;
    const shown = [path.curve.e, path.energy, path.stops.map(stop => stop.energy), ...[...this.chosen].map(k => path.terms[k].energy)];
    let [low, high] = [0, 0];
    for (const list of shown) for (const e of list) [low, high] = [Math.min(low, e), Math.max(high, e)];
    this.unit = energyUnit(high - low);
    const span = this.unit.flat ? 2 : (high - low) * this.unit.perMev;
    this.low = this.unit.flat ? -1 : low * this.unit.perMev - 0.06 * span;
    this.high = this.unit.flat ? 1 : high * this.unit.perMev + 0.1 * span;
  }

  drawAxes(width) {
    const { svg, path, upper, lower, unit } = this;
    const floor = this.hasLower() ? lower.bottom : upper.bottom;
    for (const e of ticks(this.low, this.high, (upper.bottom - upper.top) / 42)) {
      const y = this.y(e / unit.perMev);
      draw(svg, "line", { class: "grid", x1: ROOM.left, x2: this.right, y1: y, y2: y });
      draw(svg, "text", { x: ROOM.left - 7, y: y + 4, "text-anchor": "end" }, number(Number(e.toPrecision(12)), 5));
    }
    for (const s of path.length > 0 ? ticks(0, path.length, width / 90) : []) {
      draw(svg, "line", { class: "axis", x1: this.x(s), x2: this.x(s), y1: floor, y2: floor + 5 });
      draw(svg, "text", { x: this.x(s), y: floor + 18, "text-anchor": "middle" }, number(Number(s.toPrecision(12)), 5));
    }
    const frame = (top, bottom) => draw(svg, "rect", { class: "axis", x: ROOM.left, y: top, width: this.right - ROOM.left, height: bottom - top });
    frame(upper.top, upper.bottom);
    const middle = (upper.top + upper.bottom) / 2;
    draw(svg, "text", { class: "label", x: (ROOM.left + this.right) / 2, y: floor + 35, "text-anchor": "middle" }, "Reaction coordinate (rad)");
    const label = draw(svg, "text", { class: "label", x: 0, y: 0, "text-anchor": "middle", transform: `translate(13 ${middle}) rotate(-90)` }, "E − E");
    draw(label, "tspan", { dy: 3, "font-size": 9 }, "initial");
    draw(label, "tspan", { dy: -3 }, ` (${unit.name})`);
  }

  drawCurves() {
    const { svg, path } = this;
    const line = (xs, ys) => Array.from(xs, (s, k) => `${k ? "L" : "M"}${this.x(s).toFixed(1)} ${this.y(ys[k]).toFixed(2)}`).join("");
    for (const k of this.chosen) {
      const curve = draw(svg, "path", { class: "term", d: line(path.at, path.terms[k].energy), "data-curve": k });
      curve.style.stroke = `var(--term-${k % 7})`;
      if (k > 0) curve.style.strokeDasharray = ["7 3", "3 3", "9 3 2 3", "12 4", "2 4", "6 2 2 2 2 2"][(k - 1) % 6];
    }
    draw(svg, "path", { class: "curve", d: line(path.curve.s, path.curve.e) });
    const images = path.at.length, radius = images <= 45 ? 3.2 : images <= 120 ? 2 : 0;
    if (radius) path.at.forEach((s, k) => draw(svg, "circle", { class: "image", cx: this.x(s), cy: this.y(path.energy[k]), r: radius }));
    const size = path.stops.length > 30 ? 3.5 : 6;
    for (const stop of path.stops) {
      const [x, y] = [this.x(stop.s), this.y(stop.energy)];
      const shape = stop.kind === "saddle" ? `M${x} ${y - size}L${x + size} ${y}L${x} ${y + size}L${x - size} ${y}Z` : null;
      const mark = shape
        ? draw(svg, "path", { class: "saddle", d: shape })
        : stop.kind === "minimum" ? draw(svg, "circle", { class: "minimum", cx: x, cy: y, r: size - 1.5 }) : null;
      if (mark) draw(mark, "title", {}, `${stop.name}: ${number(stop.energy, 7)} meV`);
    }
  }

  /** The topological charge of the images. */
  drawCharge() {
    const { svg, path, lower } = this, { charge } = path;
    let [low, high] = [Math.min(0, ...charge), Math.max(0, ...charge)];
    if (high - low < 0.1) [low, high] = [-0.5, 0.5];
    const room = 0.12 * (high - low);
    const y = q => lower.bottom - ((q - low + room) / (high - low + 2 * room)) * (lower.bottom - lower.top);
    for (const q of ticks(low, high + 1e-9, 2)) {
      draw(svg, "line", { class: "grid", x1: ROOM.left, x2: this.right, y1: y(q), y2: y(q) });
      draw(svg, "text", { x: ROOM.left - 7, y: y(q) + 4, "text-anchor": "end" }, number(Number(q.toPrecision(6)), 3));
    }
    draw(svg, "path", { class: "curve", d: Array.from(path.at, (s, k) => `${k ? "L" : "M"}${this.x(s).toFixed(1)} ${y(charge[k]).toFixed(2)}`).join("") });
    draw(svg, "rect", { class: "axis", x: ROOM.left, y: lower.top, width: this.right - ROOM.left, height: lower.bottom - lower.top });
    draw(svg, "text", { class: "label", "text-anchor": "middle", transform: `translate(13 ${(lower.top + lower.bottom) / 2}) rotate(-90)` }, "Charge");
  }

  /** A column for each place of the path, a row for each site; site 0 is at the bottom. Where neighbours are opposite, odd ones are turned. */
  drawMap() {
    const { svg, path, lower } = this;
    const sites = path.sites.length, columns = path.length > 0 ? 320 : 1;
    this.pixels ??= new Map();
    const mark = `${this.scheme} ${this.stagger}`;
    if (!this.pixels.has(mark)) this.pixels.set(mark, this.mapImage(columns, sites));
    draw(svg, "image", {
      id: "map", href: this.pixels.get(mark), x: ROOM.left, y: lower.top, width: this.right - ROOM.left,
      height: lower.bottom - lower.top, preserveAspectRatio: "none",
    }).style.imageRendering = sites < 200 ? "pixelated" : "auto";
    draw(svg, "rect", { class: "axis", x: ROOM.left, y: lower.top, width: this.right - ROOM.left, height: lower.bottom - lower.top });
    const first = path.sites[0], last = path.sites[sites - 1];
    const y = k => lower.bottom - ((k + 0.5) / sites) * (lower.bottom - lower.top);
    draw(svg, "text", { x: ROOM.left - 7, y: Math.min(y(0) + 4, lower.bottom), "text-anchor": "end" }, String(first));
    if (sites > 1) draw(svg, "text", { x: ROOM.left - 7, y: Math.max(y(sites - 1) + 4, lower.top + 9), "text-anchor": "end" }, String(last));
    draw(svg, "text", { class: "label", "text-anchor": "middle", transform: `translate(13 ${(lower.top + lower.bottom) / 2}) rotate(-90)` }, this.stagger ? "Site, staggered" : "Site");
  }

  mapImage(columns, sites) {
    const { path } = this;
    const canvas = make("canvas", { width: columns, height: sites });
    const context = canvas.getContext("2d"), image = context.createImageData(columns, sites);
    const spins = new Float32Array(3 * sites), rgb = [0, 0, 0], paint = COLOURS[this.scheme].paint;
    const vacant = path.sites.map(site => path.data.vacant.includes(site));
    for (let j = 0; j < columns; j++) {
      path.spinsAt(columns > 1 ? (j / (columns - 1)) * path.length : 0, spins);
      for (let i = 0; i < sites; i++) {
        const sign = this.stagger && path.sites[i] % 2 ? -1 : 1, at = 4 * ((sites - 1 - i) * columns + j);
        paint(sign * spins[3 * i], sign * spins[3 * i + 1], sign * spins[3 * i + 2], rgb, 0);
        for (let c = 0; c < 3; c++) image.data[at + c] = 255 * rgb[c];
        image.data[at + 3] = vacant[i] ? 0 : 255;
      }
    }
    context.putImageData(image, 0, 0);
    return canvas.toDataURL();
  }

  drawCursor() {
    const floor = this.hasLower() ? this.lower.bottom : this.upper.bottom;
    this.cursor = draw(this.svg, "line", { class: "cursor", y1: this.upper.top, y2: floor });
    this.marker = draw(this.svg, "circle", { id: "marker", class: "marker", r: 6 });
    this.value = draw(this.svg, "text", { class: "value" });
  }

  /** The line, the marker and its number to s. */
  move(s) {
    this.s = s;
    if (!this.cursor) return;
    const [x, e] = [this.x(s), this.path.energyAt(s)], y = this.y(e);
    this.cursor.setAttribute("x1", x);
    this.cursor.setAttribute("x2", x);
    this.marker.setAttribute("cx", x);
    this.marker.setAttribute("cy", y);
    const right = x < (ROOM.left + this.right) / 2;
    this.value.textContent = `${number(e * this.unit.perMev, 5)} ${this.unit.name}`;
    this.value.setAttribute("text-anchor", right ? "start" : "end");
    this.value.setAttribute("x", x + (right ? 10 : -10));
    this.value.setAttribute("y", Math.max(y - 8, this.upper.top + 13));
  }
}
