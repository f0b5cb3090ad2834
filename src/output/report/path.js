// The path: what Rust packed, unpacked; spins and energy at any place of it.

function bytesOf(base64) {
  const text = atob(base64);
  return Uint8Array.from(text, c => c.charCodeAt(0));
}

/** A column of numbers: 32-bit floats, low byte first. */
function column(base64) {
  const view = new DataView(bytesOf(base64).buffer);
  return Float32Array.from({ length: view.byteLength / 4 }, (_, k) => view.getFloat32(4 * k, true));
}

/** The unit vector of a point of the octahedron unfolded on a square: undoes `octahedral` of pack.rs. */
function unfolded(u, v, out, at) {
  const z = 1 - Math.abs(u) - Math.abs(v);
  let x = u, y = v;
  if (z < 0) {
    x = (1 - Math.abs(v)) * (u < 0 ? -1 : 1);
    y = (1 - Math.abs(u)) * (v < 0 ? -1 : 1);
  }
  const length = Math.hypot(x, y, z);
  out[at] = x / length;
  out[at + 1] = y / length;
  out[at + 2] = z / length;
}

/** Spins (image, site, xyz) from their packed form: steps from image to image, low bytes first, then high bytes. */
async function spinsOf(packed, images, sites, scale) {
  const stream = new Blob([bytesOf(packed)]).stream().pipeThrough(new DecompressionStream("deflate"));
  const bytes = new Uint8Array(await new Response(stream).arrayBuffer());
  const half = bytes.length / 2;
  const spins = new Float32Array(images * sites * 3);
  const now = new Int32Array(2 * sites);
  for (let k = 0, b = 0; k < images; k++) {
    for (let j = 0; j < 2 * sites; j++, b++) {
      const zigzag = bytes[b] | (bytes[half + b] << 8);
      now[j] += (zigzag >> 1) ^ -(zigzag & 1);
    }
    for (let i = 0; i < sites; i++) unfolded(now[2 * i] / scale, now[2 * i + 1] / scale, spins, 3 * (k * sites + i));
  }
  return spins;
}

/** Along the great circle from a to b (3 numbers at an offset each), at fraction t. */
function slerp(from, a, b, t, out, at) {
  const [ax, ay, az, bx, by, bz] = [from[a], from[a + 1], from[a + 2], from[b], from[b + 1], from[b + 2]];
  const sin = Math.hypot(ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx);
  const cos = ax * bx + ay * by + az * bz;
  const angle = Math.atan2(sin, cos);
  let p = 1 - t, q = t;
  if (sin > 1e-6) {
    p = Math.sin((1 - t) * angle) / sin;
    q = Math.sin(t * angle) / sin;
  } else if (cos < 0) {
    p = t < 0.5 ? 1 : 0;
    q = 1 - p;
  }
  const [x, y, z] = [p * ax + q * bx, p * ay + q * by, p * az + q * bz];
  const length = Math.hypot(x, y, z);
  out[at] = x / length;
  out[at + 1] = y / length;
  out[at + 2] = z / length;
}

/** The last place of an ascending list that is not above x, but never the last one of all. */
function interval(list, x) {
  let low = 0, high = list.length - 1;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (list[middle] <= x) low = middle; else high = middle;
  }
  return low;
}

/** Between the points of a table, along straight lines. */
function between(xs, ys, x) {
  if (xs.length < 2) return ys[0] ?? 0;
  const k = interval(xs, x);
  const h = xs[k + 1] - xs[k];
  return ys[k] + (h > 0 ? clamp((x - xs[k]) / h, 0, 1) : 0) * (ys[k + 1] - ys[k]);
}

class Path {
  constructor(data) {
    this.data = data;
    this.sites = data.sites_shown;
    this.images = data.images_shown;
    this.at = column(data.reaction_coordinate_rad);
    this.energy = column(data.energy_above_initial_meV);
    this.torque = column(data.max_perpendicular_torque_meV);
    this.places = data.lattice && column(data.lattice.places);
    this.charge = data.lattice?.charge && column(data.lattice.charge);
    this.terms = data.terms.map(term => ({ name: term.name, energy: column(term.above_initial_meV) }));
    const length = this.at.length ? this.at[this.at.length - 1] : 0;
    this.length = length > 1e-9 ? length : 0;
    this.stops = stops(data.summary, this.length);
    this.curve = curve(column(data.profile.reaction_coordinate_rad), column(data.profile.energy_above_initial_meV), this);
  }

  async unpack() {
    const { packed, scale } = this.data.spins;
    this.spins = await spinsOf(packed, this.images.length, this.sites.length, scale);
  }

  /** Energy above the initial state (meV) at s (rad). */
  energyAt(s) {
    return between(this.curve.s, this.curve.e, s);
  }

  /** The shown image before s, and how far on the way to the next one. */
  place(s) {
    if (this.images.length < 2 || !(this.length > 0)) return { k: 0, t: 0 };
    const k = Math.min(interval(this.at, s), this.images.length - 2);
    const h = this.at[k + 1] - this.at[k];
    return { k, t: h > 0 ? clamp((s - this.at[k]) / h, 0, 1) : 0 };
  }

  /** Writes the spins at s into `out`, three numbers a site. */
  spinsAt(s, out) {
    const { k, t } = this.place(s);
    const n = 3 * this.sites.length;
    if (t === 0 || this.images.length < 2) {
      out.set(this.spins.subarray(k * n, (k + 1) * n));
      return;
    }
    for (let j = 0; j < n; j += 3) slerp(this.spins, k * n + j, (k + 1) * n + j, t, out, j);
  }

  /** The number of the image at s, with a fraction between two. */
  imageAt(s) {
    const { k, t } = this.place(s);
    return t === 0 ? this.images[k] : this.images[k] + t * (this.images[k + 1] - this.images[k]);
  }

  /** The state at rest at s, if there is one there. */
  stopAt(s) {
    return this.stops.find(stop => Math.abs(stop.s - s) <= 1e-4 * this.length);
  }
}

/** Ends, saddles and minima in path order. */
function stops(summary, length) {
  const start = summary.initial.energy_meV;
  const above = state => state.energy_above_initial_meV ?? state.energy_meV - start;
  const list = [{ name: "Initial state", kind: "end", s: 0, energy: 0, state: summary.initial }];
  summary.saddles.forEach((state, k) =>
    list.push({ name: `Saddle ${k}`, kind: "saddle", s: state.reaction_coordinate_rad, energy: above(state), state }));
  summary.intermediate_minima.forEach((state, k) =>
    list.push({ name: `Minimum ${k}`, kind: "minimum", s: state.reaction_coordinate_rad, energy: above(state), state }));
  const inside = list.splice(1).sort((a, b) => a.s - b.s);
  return [...list, ...inside, { name: "Final state", kind: "end", s: length, energy: above(summary.final), state: summary.final }];
}

/** The interpolated energy with the saddles in it, or the images where there is none. */
function curve(s, e, path) {
  if (s.length < 2) return { s: path.at, e: path.energy };
  const near = 1e-6 * path.length;
  const saddles = path.stops.filter(stop => stop.kind === "saddle");
  const points = Array.from(s, (x, k) => [x, e[k]]).filter(p => saddles.every(stop => Math.abs(stop.s - p[0]) > near));
  points.push(...saddles.map(stop => [stop.s, stop.energy]));
  points.sort((a, b) => a[0] - b[0]);
  return { s: points.map(p => p[0]), e: points.map(p => p[1]) };
}
