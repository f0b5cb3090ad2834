/** Where the run is from, and what of it is not shown. */
function introduce() {
  const { spacing_nm: spacing, periodic, frozen, vacant, sites, images } = data;
  const parts = [data.material.name, data.lattice?.words ?? `${periodic ? "ring" : "chain"} of ${plural(sites, "site")}${spacing && sites > 1 ? `, ${number(spacing, 4)} nm apart` : ""}`];
  if (frozen.length) parts.push(`${frozen.length} frozen`);
  if (vacant.length) parts.push(`${vacant.length} vacant`);
  $("subject").textContent = [...parts, `spinneb ${data.summary.version}`].filter(Boolean).join(" · ");
  const notes = [];
  if (path.sites.length < sites) notes.push(`Of ${sites} sites ${path.sites.length} are drawn, evenly spaced: what happens between them is not seen.`);
  if (path.images.length < images) notes.push(`Of ${images} images ${path.images.length} are shown.`);
  if (data.profile_points > path.curve.s.length) notes.push(`Of the curve's ${data.profile_points} points one in ${Math.ceil(data.profile_points / path.curve.s.length)} is drawn.`);
  notes.push("Spins between two images turn along great circles; all numbers in full are in the files beside this page.");
  if (periodic) notes.push("The ring is drawn as one, but its spins keep the directions they have in a straight chain.");
  $("notes").textContent = notes.join(" ");
}

async function begin() {
  answer(data);
  introduce();
  tell(path, s => goAndStop(s));
  page.chart = new Chart(path, goAndStop);
  wire();
  const top = path.stops.filter(stop => stop.kind === "saddle").sort((a, b) => b.energy - a.energy)[0];
  go(top ? top.s : 0, true);
  if (!(path.length > 0)) for (const id of ["slider", "play", "previous", "next"]) $(id).disabled = true;
  if (!path.images.length || !path.sites.length) {
    document.querySelector(".view").hidden = true;
    return;
  }
  await path.unpack();
  page.view = new View(path, toggle);
  page.chart.stagger = alternates(path);
  wireView(page.view);
  page.chart.render();
  $("view").setAttribute("aria-label", path.places
    ? `The spins of the lattice at their places in three dimensions: ${plural(path.sites.length, "spin")}`
    : `The spins of the chain as arrows in three dimensions: ${plural(path.sites.length, "arrow")}`);
  go(page.s);
}

begin().catch(error => {
  $("problem").textContent = `The pictures cannot be drawn here (${error.message}). The numbers below are complete; a browser of 2024 or later shows all.`;
  $("problem").hidden = false;
  throw error;
});
