// What ties the parts together: where on the path the page is, playing, theme.

const data = JSON.parse($("data").textContent);
const path = new Path(data);
const page = { s: 0, playing: null, view: null, chart: null };

/** The page in words, a line. */
function words(s) {
  const stop = path.stopAt(s), image = path.imageAt(s);
  const place = stop ? stop.name.toLowerCase() : `image ${number(Number(image.toFixed(1)), 5)} of ${data.images - 1}`;
  return `${number(s, 4)} rad, ${number(path.energyAt(s), 6)} meV, ${place}`;
}

/** Goes to s (rad) on the path; a place of rest is said aloud and fills the table of spins. */
function go(s, moving = false) {
  page.s = clamp(s, 0, path.length);
  const text = words(page.s);
  $("slider").value = path.length > 0 ? Math.round((2000 * page.s) / path.length) : 0;
  $("slider").setAttribute("aria-valuetext", text);
  $("where").textContent = text;
  page.chart.move(page.s);
  page.view?.show(page.s);
  if (moving) return;
  clearTimeout(page.saying);
  page.saying = setTimeout(() => {
    if (document.activeElement !== $("slider")) $("live").textContent = `Reaction coordinate ${text}`;
    $("spins-table").dataset.s = page.s;
    $("spins-table").dispatchEvent(new Event("rest"));
  }, 300);
}

function goAndStop(s) {
  pause();
  go(s);
}

/** Seconds from end to end at speed 1. */
const DURATION = clamp(6 + 0.04 * path.images.length, 6, 20);

function play() {
  if (page.playing || !(path.length > 0) || !path.spins) return;
  if (page.s >= path.length) go(0, true);
  page.playing = { last: performance.now(), rest: 0 };
  label();
  still.matches ? stepwise(page.playing) : requestAnimationFrame(now => frame(page.playing, now));
}

function pause() {
  if (!page.playing) return;
  page.playing = null;
  label();
  go(page.s);
}

function toggle() {
  page.playing ? pause() : play();
}

function label() {
  const playing = Boolean(page.playing);
  $("play").setAttribute("aria-label", playing ? "Pause" : "Play along the path");
  $("play").querySelector("path").setAttribute("d", playing ? "M3 2h3.6v12H3zM9.4 2H13v12H9.4z" : "M3 1.5v13L14 8z");
  $("play-word").textContent = playing ? "Pause" : "Play";
}

const speed = () => Number($("speed").value);

/** At the end: rests for a moment and begins again, or stops. */
function ended(run, seconds) {
  if (page.s < path.length) return false;
  if (!$("repeat").checked) {
    pause();
    return true;
  }
  run.rest += seconds;
  if (run.rest > 0.8) {
    run.rest = 0;
    go(0, true);
  }
  return false;
}

function frame(run, now) {
  if (page.playing !== run) return;
  const seconds = clamp((now - run.last) / 1000, 0, 0.1);
  run.last = now;
  if (page.s < path.length) go(page.s + (seconds * speed() * path.length) / DURATION, true);
  else if (ended(run, seconds)) return;
  requestAnimationFrame(later => frame(run, later));
}

/** Without motion: from image to image. */
function stepwise(run) {
  if (page.playing !== run) return;
  if (page.s < path.length) go(path.at.find(s => s > page.s + 1e-6 * path.length) ?? path.length, true);
  else if (ended(run, 1)) return;
  setTimeout(() => stepwise(run), 700 / speed());
}

/** The place of rest before or after this one. */
function neighbour(direction) {
  const near = 1e-3 * path.length;
  const later = path.stops.filter(stop => direction * (stop.s - page.s) > near);
  return later.length ? (direction > 0 ? later[0] : later[later.length - 1]).s : page.s;
}

function wire() {
  $("slider").addEventListener("input", () => goAndStop((Number($("slider").value) * path.length) / 2000));
  $("slider").addEventListener("keydown", event => {
    const images = { PageUp: 1, PageDown: -1 }[event.key];
    const step = { ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1 }[event.key];
    if (event.altKey || event.ctrlKey || event.metaKey) return;
    if (step) goAndStop(page.s + (step * path.length) / (event.shiftKey ? 2000 : 200));
    else if (images) {
      const near = 1e-6 * path.length;
      const places = Array.from(path.at).filter(s => images * (s - page.s) > near);
      goAndStop(places.length ? (images > 0 ? places[0] : places[places.length - 1]) : page.s);
    } else if (event.key === " ") toggle();
    else return;
    event.preventDefault();
  });
  $("play").onclick = toggle;
  $("previous").onclick = () => goAndStop(neighbour(-1));
  $("next").onclick = () => goAndStop(neighbour(1));
  $("theme").onchange = () => {
    document.documentElement.dataset.theme = $("theme").value;
    page.view?.refresh();
  };
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => page.view?.refresh());
  document.addEventListener("keydown", event => {
    const more = document.querySelector(".more");
    if (event.key === "Escape" && more.open) {
      more.open = false;
      more.querySelector("summary").focus();
    }
  });
}

