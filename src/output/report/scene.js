// Where the spins stand and from where they are seen. The world's axes: along the chain, into the page, up. Lengths are in
// distances between neighbouring sites that are shown.

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
};

const VIEWS = { tilted: { line: [-24, 20], ring: [-20, 40] }, side: [0, 0], top: [0, 90], end: [90, 0] };

class Scene {
  constructor(path) {
    this.path = path;
    this.axes = worldAxes(path.data.direction);
    this.lab = new Float32Array(3 * path.sites.length);
    this.live = this.sites = path.sites.map((_, k) => k).filter(k => !path.data.vacant.includes(path.sites[k]));
    this.stride = 1;
    this.scheme = "direction";
    this.stretch = 1;
    this.stagger = false;
    this.turn = [0, 0];
    this.zoom = 1;
    this.shift = [0, 0];
    this.lies = this.alongChain();
  }

  /** Puts the sites in a line or a ring. */
  arrange(kind) {
    this.kind = kind;
    const n = this.path.sites.length;
    const { places, closed } = LAYOUTS[kind](n, 1);
    this.places = Array.from({ length: n }, (_, k) => places(k));
    this.closed = closed && n > 2;
    this.thin(1);
  }

  /** Draws every `stride`-th site, with arrows as much longer; an odd stride keeps even and odd sites taking turns. */
  thin(stride) {
    this.stride = stride;
    this.live = this.sites.filter(k => k % stride === 0);
    this.world = new Float32Array(3 * this.live.length);
    this.colour = new Float32Array(3 * this.live.length);
    const { arrow } = LAYOUTS[this.kind](this.places.length, stride);
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
    const head = clamp(0.16 * length, 0.12 * this.stride, Math.max(0.5 * this.stride, 0.07 * length));
    this.arrow = { length, head, shaft: 0.4 * head, point: Math.min(0.45 * length, 2.7 * head) };
  }

  look(view) {
    this.view = view;
    const angles = VIEWS[view];
    return Array.isArray(angles) ? angles : angles[this.kind];
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
    const radius = reach + Math.max(...this.places.map(place => Math.hypot(...place)));
    const nearest = 1.5 * reach + Math.max(...this.places.map(place => dot(place, axes.eye)));
    let [target, distance] = [[0, 0, 0], (3 * radius) / Scene.TAN];
    for (let round = 0; round < 8; round++) {
      const camera = { ...axes, target, distance, width: 2 * aspect, height: 2, scale: 1 / Scene.TAN };
      let [left, right, top, bottom] = [Infinity, -Infinity, Infinity, -Infinity];
      for (const place of this.places) {
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
    const list = this.places.slice(1).map((_, k) => [k, k + 1]);
    if (this.closed) list.push([this.places.length - 1, 0]);
    return list;
  }
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
