// The spins in 3D with everything that turns, moves and explains them.

class View {
  /** `onPlay` answers the space bar. */
  constructor(path, onPlay) {
    this.scene = new Scene(path);
    this.canvas = $("view");
    this.onPlay = onPlay;
    Object.assign(this, { s: 0, scrolled: -1e9 });
    this.start(Glass.on(this.canvas));
    this.measure();
    this.arrange(path.places ? "lattice" : path.data.periodic ? "ring" : "line");
    new ResizeObserver(() => this.measure()).observe($("frame"));
    this.listen();
  }

  /** With this renderer, or a flat one on a fresh canvas: a canvas keeps the kind it was first given. */
  start(renderer) {
    if (!renderer) {
      const fresh = this.canvas.cloneNode(true);
      this.canvas.replaceWith(fresh);
      this.canvas = fresh;
    }
    this.renderer = renderer ?? Flat.on(this.canvas);
    this.canvas.addEventListener("webglcontextlost", () => {
      this.start(null);
      this.renderer.build(this.scene);
      this.measure();
      this.steer();
    });
  }

  measure() {
    const { clientWidth, clientHeight } = $("frame");
    this.ratio = Math.min(devicePixelRatio || 1, 2);
    [this.width, this.height] = [Math.max(clientWidth, 1), Math.max(clientHeight, 1)];
    for (const canvas of [this.canvas, $("labels")]) {
      canvas.width = Math.round(this.width * this.ratio);
      canvas.height = Math.round(this.height * this.ratio);
    }
    if (this.scene.kind) {
      this.frame();
      this.refresh();
    }
  }

  arrange(kind) {
    this.scene.arrange(kind);
    this.renderer.build(this.scene);
    this.look("tilted");
  }

  /** Everything in the picture, then as many arrows as have room. */
  frame() {
    this.scene.fit(this.width / this.height, this.home);
    this.thin();
  }

  /** Draws every third, ninth … site of a line as long as the arrows would stand closer than this (px). */
  thin() {
    const { scene } = this, closest = scene.lies ? 8 : 4;
    if (scene.kind === "lattice") return this.rebuild(scene.choose(scene.camera(this.width, this.height)));
    const [, , , perSite] = project(scene.camera(this.width, this.height), scene.center);
    let stride = 1;
    while (scene.kind === "line" && stride * perSite < closest && 6 * stride < scene.places.length) stride *= 3;
    if (stride === scene.stride) return;
    scene.thin(stride);
    this.rebuild(true);
  }

  /** After a change of what is drawn. */
  rebuild(changed) {
    if (!changed) return;
    this.posed = false;
    this.renderer.build(this.scene);
  }

  /** To one of the named views, without a detour through zoom and shift of before. */
  look(view) {
    this.home = this.scene.look(view);
    Object.assign(this.scene, { zoom: 1, shift: [0, 0] });
    this.frame();
    this.turnTo(this.home);
    for (const button of document.querySelectorAll("[data-view]")) button.setAttribute("aria-pressed", button.dataset.view === view);
  }

  /** Turns in a quarter of a second, or at once where motion is not wanted. */
  turnTo(angles) {
    const from = this.scene.turn, began = performance.now();
    const token = (this.turning = {});
    const step = now => {
      if (this.turning !== token) return;
      const t = still.matches || !this.shown ? 1 : clamp((now - began) / 250, 0, 1);
      const ease = t * t * (3 - 2 * t);
      this.scene.turn = t === 1 ? [...angles] : from.map((a, k) => a + ease * (angles[k] - a));
      this.refresh();
      if (t < 1) requestAnimationFrame(step);
    };
    step(began);
  }

  turnBy(right, up) {
    $("hint").hidden = true;
    this.turning = null;
    const [a, e] = this.scene.turn;
    this.scene.turn = [a + right, clamp(e + up, -90, 90)];
    for (const button of document.querySelectorAll("[data-view]")) button.setAttribute("aria-pressed", "false");
    this.refresh();
  }

  /** Zooms; what is `at` a place of the canvas (px) stays there. */
  zoomBy(factor, at = [this.width / 2, this.height / 2]) {
    $("hint").hidden = true;
    const before = this.scene.zoom;
    this.scene.zoom = clamp(before * factor, 0.4, 60);
    const grown = this.scene.zoom / before - 1;
    this.moveBy(-grown * (at[0] - this.width / 2), -grown * (at[1] - this.height / 2));
    this.thin();
  }

  /** Moves the picture by pixels. */
  moveBy(x, y) {
    const camera = this.scene.camera(this.width, this.height);
    const size = camera.distance / camera.scale;
    this.scene.shift = add([...this.scene.shift, 0], [-x * size, y * size, 0]).slice(0, 2);
    this.refresh();
  }

  show(s) {
    this.s = s;
    this.posed = false;
    this.refresh();
  }

  /** Draws with the next frame of the screen. */
  refresh() {
    if (this.waiting || !this.scene.path.spins) return;
    this.waiting = true;
    requestAnimationFrame(() => {
      this.waiting = false;
      this.paint();
    });
  }

  paint() {
    if (this.scene.kind === "lattice") this.thin();
    if (!this.posed) this.scene.pose(this.s);
    this.posed = this.shown = true;
    const camera = this.scene.camera(this.width, this.height);
    this.renderer.draw(this.scene, camera, rgbOf(this.canvas), this.ratio);
    this.letter(camera);
    this.drawKey(camera);
  }

  /** Numbers of sites, and the spin under the pointer. */
  letter(camera) {
    const canvas = $("labels"), c = canvas.getContext("2d");
    c.setTransform(this.ratio, 0, 0, this.ratio, 0, 0);
    c.clearRect(0, 0, this.width, this.height);
    c.font = "12px system-ui, sans-serif";
    c.textAlign = "center";
    c.fillStyle = getComputedStyle(canvas).color;
    const { path, places, arrow, kind, stride } = this.scene;
    c.globalAlpha = 0.75;
    for (const k of new Set({ line: [0, places.length - 1], ring: [0], lattice: [] }[kind])) {
      const [x, y, depth] = project(camera, add(places[k], [0, 0, -0.5 * arrow.length]));
      if (depth > 0) c.fillText(String(path.sites[k]), x, y + 16);
    }
    c.textAlign = "left";
    if (stride > 1) c.fillText(`1 of ${stride} sites is drawn: zoom in for all`, 10, this.height - 10);
    if (this.scene.discs && this.scene.marks === "auto") c.fillText("a disc for each spin: zoom in for arrows", 10, this.height - 10);
    c.textAlign = "center";
    c.globalAlpha = 1;
    if (this.pointed !== undefined) this.tell(c, camera, this.pointed);
  }

  tell(c, camera, k) {
    const { path, lab, places } = this.scene;
    const [x, y] = project(camera, places[k]);
    const m = [0, 1, 2].map(i => number(Number(lab[3 * k + i].toFixed(3)), 4));
    const text = `site ${path.sites[k]}: m = (${m.join(", ")})`;
    const wide = c.measureText(text).width + 14;
    const left = clamp(x - wide / 2, 4, this.width - wide - 4), top = y > 60 ? y - 46 : y + 24;
    c.strokeStyle = c.fillStyle;
    c.beginPath();
    c.arc(x, y, 6, 0, 2 * Math.PI);
    c.stroke();
    const ink = c.fillStyle;
    c.fillStyle = getComputedStyle($("frame").parentElement).backgroundColor;
    c.globalAlpha = 0.92;
    c.fillRect(left, top, wide, 22);
    c.globalAlpha = 1;
    c.strokeRect(left, top, wide, 22);
    c.fillStyle = ink;
    c.textAlign = "left";
    c.fillText(text, left + 7, top + 15);
  }

  /** A sphere of colours that turns with the picture, with the axes of the spins. */
  drawKey(camera) {
    const canvas = $("sphere");
    const size = canvas.clientWidth, n = Math.round(size * this.ratio);
    const mark = `${this.scene.turn} ${this.scene.scheme} ${n} ${getComputedStyle($("labels")).color}`;
    if (this.keyed === mark) return;
    this.keyed = mark;
    canvas.width = canvas.height = n;
    const c = canvas.getContext("2d"), image = c.createImageData(n, n), rgb = [0, 0, 0];
    const { axes, scheme } = this.scene, radius = 0.31 * n;
    const toLab = v => [0, 1, 2].map(i => v[0] * axes[0][i] + v[1] * axes[1][i] + v[2] * axes[2][i]);
    const [right, up, eye] = [camera.right, camera.up, camera.eye].map(toLab);
    for (let row = 0, at = 0; row < n; row++) {
      for (let k = 0; k < n; k++, at += 4) {
        const [x, y] = [(k + 0.5 - n / 2) / radius, (n / 2 - row - 0.5) / radius], far = Math.hypot(x, y);
        const cover = clamp((1 - far) * radius + 0.5, 0, 1);
        if (cover === 0) continue;
        const z = Math.sqrt(Math.max(0, 1 - far * far));
        const m = unit([0, 1, 2].map(i => x * right[i] + y * up[i] + z * eye[i]));
        COLOURS[scheme].paint(m[0], m[1], m[2], rgb, 0);
        for (let i = 0; i < 3; i++) image.data[at + i] = 255 * rgb[i];
        image.data[at + 3] = 255 * cover;
      }
    }
    c.putImageData(image, 0, 0);
    this.drawAxes(c, n, radius, [right, up, eye]);
  }

  drawAxes(c, n, radius, [right, up, eye]) {
    const ink = getComputedStyle($("labels")).color;
    c.strokeStyle = c.fillStyle = ink;
    c.lineWidth = this.ratio;
    c.beginPath();
    c.arc(n / 2, n / 2, radius, 0, 2 * Math.PI);
    c.stroke();
    c.font = `${12 * this.ratio}px system-ui, sans-serif`;
    c.textAlign = "center";
    c.textBaseline = "middle";
    ["x", "y", "z"].forEach((name, i) => {
      const [x, y, z] = [right[i], -up[i], eye[i]];
      const from = z > 0 ? 1 : Math.min(1, 1 / Math.max(Math.hypot(x, y), 1e-9));
      if (z < -0.2 && Math.hypot(x, y) < 0.75) return;
      const reach = t => [n / 2 + t * radius * x, n / 2 + t * radius * y];
      c.globalAlpha = z > -0.2 ? 1 : 0.55;
      c.beginPath();
      c.moveTo(...reach(from));
      c.lineTo(...reach(1.22));
      c.stroke();
      const [ex, ey] = reach(1.22), out = Math.max(Math.hypot(x, y), 1e-9);
      c.fillText(name, ex + (0.2 * radius * x) / out, ey + (0.2 * radius * y) / out);
    });
    c.globalAlpha = 1;
  }

  /** The picture with its background and key, as one canvas. */
  picture() {
    this.paint();
    const whole = make("canvas", { width: this.canvas.width, height: this.canvas.height });
    const c = whole.getContext("2d");
    const sky = c.createLinearGradient(0, 0, 0, whole.height);
    const colours = getComputedStyle($("frame")).backgroundImage.match(/rgba?\([^)]*\)/g) ?? [];
    if (colours.length === 2) colours.forEach((colour, k) => sky.addColorStop(k, colour));
    c.fillStyle = sky;
    c.fillRect(0, 0, whole.width, whole.height);
    c.drawImage(this.canvas, 0, 0);
    c.drawImage($("labels"), 0, 0);
    c.drawImage($("sphere"), whole.width - $("sphere").width - 6 * this.ratio, 6 * this.ratio);
    return whole;
  }

  listen() {
    this.steer();
    addEventListener("scroll", () => (this.scrolled = performance.now()), { passive: true });
    $("zoom-in").onclick = () => this.zoomBy(1.25);
    $("zoom-out").onclick = () => this.zoomBy(0.8);
    for (const button of document.querySelectorAll("[data-view]")) button.onclick = () => this.look(button.dataset.view);
    for (const button of document.querySelectorAll("[data-turn]")) {
      const [right, up] = button.dataset.turn.split(" ").map(Number);
      button.onclick = () => this.turnBy(right, up);
    }
  }

  /** Pointer, wheel and keys on the canvas. One finger turns sideways and leaves up and down to the page; two turn, zoom and move. */
  steer() {
    const canvas = this.canvas, held = new Map();
    const middle = () => [...held.values()].reduce((sum, p) => [sum[0] + p[0] / held.size, sum[1] + p[1] / held.size], [0, 0]);
    const within = ([x, y]) => {
      const box = canvas.getBoundingClientRect();
      return [x - box.left, y - box.top];
    };
    const spread = () => (held.size < 2 ? 0 : Math.hypot(...add([...[...held.values()][0], 0], [...[...held.values()][1], 0], -1)));
    canvas.addEventListener("pointerdown", event => {
      held.set(event.pointerId, [event.clientX, event.clientY]);
      canvas.setPointerCapture(event.pointerId);
      canvas.classList.add("held");
    });
    canvas.addEventListener("pointermove", event => {
      if (!held.has(event.pointerId)) return this.point(event);
      const [before, apart] = [middle(), spread()];
      held.set(event.pointerId, [event.clientX, event.clientY]);
      const now = middle(), [dx, dy] = [now[0] - before[0], now[1] - before[1]];
      if (apart > 0) this.zoomBy(spread() / apart, within(now));
      if (event.shiftKey || event.buttons & 6 || held.size > 1) this.moveBy(dx, dy);
      else this.turnBy(-0.4 * dx, event.pointerType === "touch" ? 0 : 0.4 * dy);
    });
    for (const end of ["pointerup", "pointercancel", "lostpointercapture"]) {
      canvas.addEventListener(end, event => {
        held.delete(event.pointerId);
        canvas.classList.toggle("held", held.size > 0);
      });
    }
    canvas.addEventListener("pointerleave", () => this.point(null));
    canvas.addEventListener("contextmenu", event => event.preventDefault());
    canvas.addEventListener("dblclick", () => this.look("tilted"));
    canvas.addEventListener("wheel", event => {
      // a page that is being scrolled goes on
      if (performance.now() - this.scrolled < 250) return;
      event.preventDefault();
      const step = delta => clamp(delta * (event.deltaMode ? 30 : 1), -200, 200);
      if (Math.abs(event.deltaX) > Math.abs(event.deltaY)) this.moveBy(-step(event.deltaX), 0);
      else this.zoomBy(Math.exp(-step(event.deltaY) * 0.0016), within([event.clientX, event.clientY]));
    }, { passive: false });
    canvas.addEventListener("keydown", event => this.pressed(event));
  }

  pressed(event) {
    const arrows = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
    const [x, y] = arrows[event.key] ?? [0, 0];
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (x || y) event.shiftKey ? this.moveBy(-30 * x, 30 * y) : this.turnBy(6 * x, 6 * y);
    else if (event.key === "+" || event.key === "=") this.zoomBy(1.2);
    else if (event.key === "-" || event.key === "_") this.zoomBy(1 / 1.2);
    else if (event.key === "0" || event.key === "Home") this.look("tilted");
    else if (event.key === " ") this.onPlay();
    else return;
    event.preventDefault();
  }

  /** The site next to the pointer, if there is one near it. */
  point(event) {
    let best, least = 18;
    if (event && event.pointerType !== "touch") {
      const box = this.canvas.getBoundingClientRect(), camera = this.scene.camera(this.width, this.height);
      const at = [event.clientX - box.left, event.clientY - box.top];
      for (const k of this.scene.live) {
        const [x, y] = project(camera, this.scene.places[k]);
        const far = Math.hypot(x - at[0], y - at[1]);
        if (far < least) [best, least] = [k, far];
      }
    }
    if (best !== this.pointed) {
      this.pointed = best;
      this.refresh();
    }
  }
}
