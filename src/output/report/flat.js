// The picture without WebGL: the same arrows, flat, those behind first.

class Flat {
  static on(canvas) {
    return new Flat(canvas.getContext("2d"));
  }

  constructor(context) {
    this.context = context;
  }

  build() {}

  draw(scene, camera, ink, ratio) {
    const c = this.context;
    c.setTransform(ratio, 0, 0, ratio, 0, 0);
    c.clearRect(0, 0, camera.width, camera.height);
    c.strokeStyle = css(ink, 0);
    c.lineWidth = 0.6;
    c.lineJoin = "round";
    c.beginPath();
    for (const [a, b] of scene.bonds()) {
      c.moveTo(...project(camera, scene.places[a]).slice(0, 2));
      c.lineTo(...project(camera, scene.places[b]).slice(0, 2));
    }
    c.stroke();
    if (scene.discs) return this.discs(scene, camera);
    const arrows = scene.live.map((site, k) => {
      const place = scene.places[site], spin = scene.world.subarray(3 * k, 3 * k + 3);
      return { k, depth: project(camera, place)[2], ends: [-0.5, 0.5].map(t => project(camera, add(place, spin, t * scene.arrow.length))) };
    });
    for (const { k, ends: [foot, tip] } of arrows.sort((a, b) => b.depth - a.depth)) {
      c.fillStyle = css(scene.colour, 3 * k);
      this.arrow(foot, tip, scene.arrow);
    }
  }

  discs(scene, camera) {
    const c = this.context;
    const discs = scene.live.map((site, k) => [k, ...project(camera, scene.places[site])]);
    for (const [k, x, y, , size] of discs.sort((a, b) => b[3] - a[3])) {
      c.fillStyle = css(scene.colour, 3 * k);
      c.beginPath();
      c.arc(x, y, Math.max(0.52 * scene.stretch * size, 0.7), 0, 2 * Math.PI);
      c.fill();
    }
  }

  /** From foot to tip; an arrow that points at the eye is a disc. */
  arrow(foot, tip, { head, shaft, point, length }) {
    const c = this.context, [fx, fy, , size] = foot, [tx, ty] = tip;
    const [dx, dy] = [tx - fx, ty - fy], long = Math.hypot(dx, dy);
    const [ux, uy] = long > 0 ? [dx / long, dy / long] : [0, 0];
    const neck = 1 - point / length;
    const at = (t, across) => [fx + t * dx - across * size * uy, fy + t * dy + across * size * ux];
    c.beginPath();
    if (long < 2 * head * size) c.arc(tx, ty, head * size, 0, 2 * Math.PI);
    else {
      [[0, shaft], [neck, shaft], [neck, head], [1, 0], [neck, -head], [neck, -shaft], [0, -shaft]].forEach(([t, w]) => c.lineTo(...at(t, w)));
      c.closePath();
    }
    c.fill();
    c.stroke();
  }
}
