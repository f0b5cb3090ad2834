// Where the spins stand and from where they are seen. The world's axes: along the chain, into the page, up; of a lattice x, y and z.
// Lengths are in distances between neighbouring sites that are shown.

const add = (a, b, t = 1) => [a[0] + t * b[0], a[1] + t * b[1], a[2] + t * b[2]];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const unit = a => a.map(c => c / Math.hypot(...a));

/** The world's axes in those of the spins: the chain's direction, and up as near to +z as it goes (+x for a chain along z). */
function worldAxes(chain) {
  const along = unit(chain);
  const near = Math.abs(along[2]) < 0.999 ? [0, 0, 1] : [1, 0, 0];
  const up = unit(add(near, along, -dot(near, along)));
  return [along, cross(up, along), up];
}

const LAYOUTS = {
  line(n, stride) {
    return { places: k => [k - (n - 1) / 2, 0, 0], arrow: stride * clamp((0.1 * n) / stride, 1.15, 9) };
  },
  ring(n) {
    const radius = Math.max(n, 3) / (2 * Math.PI);
    const place = k => {
      const angle = (2 * Math.PI * k) / n;
      return [-radius * Math.cos(angle), -radius * Math.sin(angle), 0];
    };
    return { places: place, closed: true, arrow: Math.max(1.15, 0.2 * radius) };
  },
  lattice(n, stride, { places }) {
    return { places: k => Array.from(places.subarray(3 * k, 3 * k + 3)), arrow: 0.95 };
  },
};

const VIEWS = { tilted: { line: [-24, 20], ring: [-20, 40], film: [-12, 52], crystal: [-28, 24] }, side: [0, 0], top: [0, 90], end: [90, 0] };

/** Of a lattice no more arrows than these are drawn at a time, and none smaller (px): discs take their place. */
const MOST_ARROWS = 6000, LEAST_ARROW = 9;

class Scene {
  constructor(path) {
    this.path = path;
    this.axes = worldAxes(path.data.direction);
    this.lab = new Float32Array(3 * path.sites.length);
    const vacant = new Set(path.data.vacant);
    this.live = this.sites = this.there = path.sites.map((_, k) => k).filter(k => !vacant.has(path.sites[k]));
    this.stride = 1;
    this.scheme = "direction";
    this.stretch = 1;
    this.stagger = false;
    this.turn = [0, 0];
    this.zoom = 1;
    this.shift = [0, 0];
    this.marks = "auto";
    this.discs = false;
    this.lies = !path.places && this.alongChain();
  }

  /** Puts the sites in a line, in a ring or where they are. */
  arrange(kind) {
    this.kind = kind;
    const n = this.path.sites.length;
    const { places, closed } = LAYOUTS[kind](n, 1, this.path);
    this.places = Array.from({ length: n }, (_, k) => places(k));
    this.outline = kind === "lattice" ? corners(this.places) : this.places;
    this.closed = closed && n > 2;
    this.thin(1);
  }

  /** Of a lattice: draws the sites at this height alone, or all. */
  layer(z) {
    this.sites = z === null ? this.there : this.there.filter(k => Math.abs(this.places[k][2] - z) < 1e-3);
    this.take(this.sites);
  }

  /** Of a lattice: an arrow for each spin in the picture where there is room for it, else discs. Whether what is drawn has changed. */
  choose(camera) {
    const [, , , perSite] = project(camera, camera.target);
    let live = this.sites, discs = this.marks === "discs" || (this.marks === "auto" && perSite < LEAST_ARROW);
    if (!discs && live.length > MOST_ARROWS) {
      live = live.filter(k => seen(camera, this.places[k]));
      discs = live.length > MOST_ARROWS;
      if (discs) live = this.sites;
    }
    if (discs === this.discs && live === this.live) return false;
    this.discs = discs;
    this.take(live);
    return true;
  }

  take(live) {
    this.live = live;
    this.world = new Float32Array(3 * live.length);
    this.colour = new Float32Array(3 * live.length);
  }

  /** Draws every `stride`-th site, with arrows as much longer; an odd stride keeps even and odd sites taking turns. */
  thin(stride) {
    this.stride = stride;
    this.take(stride > 1 ? this.sites.filter(k => k % stride === 0) : this.sites);
    const { arrow } = LAYOUTS[this.kind](this.places.length, stride, this.path);
    this.usual = this.lies ? Math.min(arrow, 1.3 * stride) : arrow;
    this.resize();
  }

  /** Whether many spins lie along the chain at one of the path's ends: longer arrows would run into each other. */
  alongChain() {
    const { path, axes, live, lab } = this;
    return [0, path.length].some(s => {
      path.spinsAt(s, lab);
      const sum = live.reduce((sum, k) => sum + dot(axes[0], lab.subarray(3 * k, 3 * k + 3)) ** 2, 0);
      return sum > 0.3 * live.length;
    });
  }

  /** The arrows' measures, after a change of their length. */
  resize() {
    const length = this.usual * this.stretch;
    const slim = this.kind === "lattice" ? 0.26 : 0.16;
    const head = clamp(slim * length, 0.12 * this.stride, Math.max(0.5 * this.stride, 0.07 * length));
    this.arrow = { length, head, shaft: 0.4 * head, point: Math.min(0.45 * length, 2.7 * head) };
  }

  look(view) {
    this.view = view;
    const angles = VIEWS[view];
    if (Array.isArray(angles)) return angles;
    const [low, high] = this.kind === "lattice" ? [this.outline[0], this.outline[7]] : [];
    return angles[low ? (high[2] - low[2] > 0.3 * Math.max(high[0] - low[0], high[1] - low[1]) ? "crystal" : "film") : this.kind];
  }

  /** Right, up and towards the eye, in the world's axes. */
  basis() {
    const [a, e] = this.turn.map(degrees => (degrees * Math.PI) / 180);
    const [sa, ca, se, ce] = [Math.sin(a), Math.cos(a), Math.sin(e), Math.cos(e)];
    return { right: [ca, sa, 0], up: [-se * sa, se * ca, ce], eye: [sa * ce, -ca * ce, se] };
  }

  /** Puts the eye and the middle of the picture so that everything is just seen from these angles. */
  fit(aspect, angles) {
    const before = this.turn;
    this.turn = angles;
    const axes = this.basis();
    this.turn = before;
    const reach = 0.5 * this.arrow.length + 0.3;
    const radius = reach + Math.max(...this.outline.map(place => Math.hypot(...place)));
    const nearest = 1.5 * reach + Math.max(...this.outline.map(place => dot(place, axes.eye)));
    let [target, distance] = [[0, 0, 0], (3 * radius) / Scene.TAN];
    for (let round = 0; round < 8; round++) {
      const camera = { ...axes, target, distance, width: 2 * aspect, height: 2, scale: 1 / Scene.TAN };
      let [left, right, top, bottom] = [Infinity, -Infinity, Infinity, -Infinity];
      for (const place of this.outline) {
        const [x, y, , scale] = project(camera, place), room = reach * scale;
        [left, right] = [Math.min(left, x - room), Math.max(right, x + room)];
        [top, bottom] = [Math.min(top, y - room), Math.max(bottom, y + room)];
      }
      const perPixel = distance * Scene.TAN;
      target = add(target, axes.right, ((left + right) / 2 - aspect) * perPixel);
      target = add(target, axes.up, (1 - (top + bottom) / 2) * perPixel);
      distance = Math.max(nearest, distance * Math.max((right - left) / (1.95 * aspect), (bottom - top) / 1.85));
    }
    Object.assign(this, { center: target, distance });
  }

  /** Everything that a picture needs to project points. */
  camera(width, height) {
    const { right, up, eye } = this.basis();
    const distance = this.distance / this.zoom;
    const target = add(add(this.center, right, this.shift[0]), up, this.shift[1]);
    return { right, up, eye, target, distance, width, height, scale: height / (2 * Scene.TAN) };
  }

  /** Directions and colours of the spins at s. */
  pose(s) {
    const { path, lab, axes } = this;
    path.spinsAt(s, lab);
    const paint = COLOURS[this.scheme].paint;
    this.live.forEach((site, k) => {
      const sign = this.stagger && path.sites[site] % 2 ? -1 : 1;
      const m = [sign * lab[3 * site], sign * lab[3 * site + 1], sign * lab[3 * site + 2]];
      paint(m[0], m[1], m[2], this.colour, 3 * k);
      for (let c = 0; c < 3; c++) this.world[3 * k + c] = dot(axes[c], m);
    });
  }

  /** Pairs of neighbouring places to join with a line. */
  bonds() {
    if (this.kind === "lattice") return [];
    const list = this.places.slice(1).map((_, k) => [k, k + 1]);
    if (this.closed) list.push([this.places.length - 1, 0]);
    return list;
  }
}

/** The corners of the box of these places, the least first and the greatest last. */
function corners(places) {
  const [low, high] = [Math.min, Math.max].map(of => [0, 1, 2].map(c => places.reduce((x, place) => of(x, place[c]), places[0][c])));
  return Array.from({ length: 8 }, (_, k) => [0, 1, 2].map(c => ((k >> c) & 1 ? high : low)[c]));
}

/** Tangent of half the angle of view, from top to bottom. */
Scene.TAN = Math.tan((13 * Math.PI) / 180);

/** A point on the screen: right and down in pixels, and its distance from the eye. */
function project(camera, point) {
  const from = add(point, camera.target, -1);
  const depth = camera.distance - dot(from, camera.eye);
  const scale = camera.scale / Math.max(depth, 1e-3);
  return [camera.width / 2 + scale * dot(from, camera.right), camera.height / 2 - scale * dot(from, camera.up), depth, scale];
}

/** Whether an arrow there can be seen. */
function seen({ right, up, eye, target, distance, width, height, scale }, [x, y, z]) {
  const [a, b, c] = [x - target[0], y - target[1], z - target[2]];
  const depth = distance - (a * eye[0] + b * eye[1] + c * eye[2]);
  const [across, high] = [a * right[0] + b * right[1] + c * right[2], a * up[0] + b * up[1] + c * up[2]];
  return depth > 0 && (Math.abs(across) - 1) * scale < 0.5 * width * depth && (Math.abs(high) - 1) * scale < 0.5 * height * depth;
}
