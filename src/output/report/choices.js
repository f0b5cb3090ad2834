/** The choices of the picture. */
function wireView(view) {
  for (const [name, { words }] of Object.entries(COLOURS)) $("colours").append(make("option", { value: name }, words));
  if (!data.periodic) $("layout").querySelector('[value="ring"]').remove();
  if (path.places) wireLattice(view);
  else $("layout").value = view.scene.kind;
  $("layout").onchange = () => view.arrange($("layout").value);
  $("length").oninput = () => {
    view.scene.stretch = Number($("length").value);
    view.scene.resize();
    view.renderer.build(view.scene);
    view.refresh();
  };
  const recolour = () => {
    view.scene.scheme = page.chart.scheme = $("colours").value;
    view.scene.stagger = $("stagger").checked;
    view.show(page.s);
    page.chart.render();
  };
  $("colours").onchange = $("stagger").onchange = recolour;
  $("stagger-choice").hidden = !alternates(path);
  $("save").onclick = () => view.picture().toBlob(blob => {
    const link = make("a", { href: URL.createObjectURL(blob), download: `${data.summary.name}.png` });
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10000);
  });
}

/** What a lattice is drawn with, and which of its layers. */
function wireLattice(view) {
  const { scene } = view;
  $("layout").parentElement.hidden = true;
  $("marks-choice").hidden = false;
  $("marks").onchange = () => {
    scene.marks = $("marks").value;
    view.show(page.s);
  };
  const heights = [...new Set(scene.places.map(place => Number(place[2].toFixed(3))))].sort((a, b) => a - b);
  if (heights.length < 2 || heights.length > 300) return;
  $("layer-choice").hidden = false;
  heights.forEach((z, k) => $("layer").append(make("option", { value: z }, `${k + 1} of ${heights.length} along z`)));
  $("layer").onchange = () => {
    scene.layer($("layer").value === "" ? null : Number($("layer").value));
    view.rebuild(true);
    view.show(page.s);
  };
}

/** Whether neighbours of the initial state point against each other. */
function alternates({ sites, spins, places }) {
  if (places) return false;
  let sum = 0;
  for (let k = 1; k < sites.length; k++) for (let c = 0; c < 3; c++) sum += spins[3 * k + c] * spins[3 * (k - 1) + c];
  return sites.length > 1 && sum < -0.5 * (sites.length - 1);
}

