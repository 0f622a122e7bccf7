// The page: sliders, the picture of the grains, and what is measured of them.
"use strict";

const $ = id => document.getElementById(id);
const KINDS = {
  drum: {
    speed: {min: 2, max: 30, value: 15, unit: "rpm"}, fill: true, friction: 0.4,
    overrides: ({discs, fill}) => {
      // A packing fills 0.8 of what it occupies; 3.305 mm: root mean square of the diameters.
      const radius = Math.sqrt(discs * 3.305 ** 2 / 4 / (0.8 * fill));
      return [`grains.generated.count=${discs}`, `grains.generated.region.radius_mm=${radius}`, `walls.0.radius_mm=${radius}`];
    },
    friction_of: mu => [mu, 0.95], speed_of: rpm => ["turn", ["drum", rpm]],
    numbers: [["theta_deg", "slope of the surface &theta;", "&deg;"], ["surface_speed", "speed of the surface", "&radic;(gd)"]],
    about: "Discs of 3 to 3.6 mm in a rough drum, seen along its axis. Grains flow down the surface; below, they turn with the drum.",
    axis: "depth z / d, below the surface",
  },
  shear: {
    speed: {min: 2, max: 60, value: 18, unit: "1/s"}, fill: false, friction: 0.4,
    overrides: ({discs}) => {
      const width = 64 * Math.sqrt(discs / 1000), height = 90 * Math.sqrt(discs / 1000);
      return [`grains.generated.count=${discs}`, `periodic_x.x_max_mm=${width}`, `periodic_z.z_max_mm=${height}`,
        `grains.generated.region.max_mm=[${width}, ${height}]`];
    },
    friction_of: mu => [mu, mu], speed_of: rate => ["shear", [rate]],
    numbers: [["bulk_mu", "effective friction &mu;", ""], ["bulk_I", "inertial number I", ""], ["bulk_nu", "volume fraction &nu;", ""]],
    about: "Discs of 1.6 to 2.4 mm without walls: what leaves on one side comes back on the other. The height follows a pressure of 270 Pa.",
    axis: "height z / d",
  },
};
const shown = {kind: "drum", picture: null, measured: null, playing: true, fault: ""};
const pace = {frames: 0, steps: 0, seconds: 0, since: performance.now()};

// Functions of the engine's thread, each a promise. Its text is the page's own: a page in a file may load no other.
const asked = new Map();
const thread = new Worker(URL.createObjectURL(new Blob([`var _scriptDir = "";\nvar engine = ${engine};\n(${work})(engine);`], {type: "text/javascript"})));
function ask(name, value) {
  return new Promise((resolve, reject) => {
    const id = ask.count = (ask.count ?? 0) + 1;
    asked.set(id, {resolve, reject});
    thread.postMessage({id, name, value});
  });
}
const ready = new Promise(resolve => {
  thread.onmessage = ({data}) => {
    if (data.ready) resolve();
    if (data.picture) show(data.picture);
    if (data.measured) shown.measured = data.measured, tell();
    if (data.id === undefined) return data.fault && refuse(data.fault);
    const {resolve: answer, reject} = asked.get(data.id);
    asked.delete(data.id);
    data.fault ? reject(new Error(data.fault)) : answer(data.value);
  };
});

function refuse(fault) {
  shown.fault = fault;
  $("fault").textContent = fault;
  $("fault").hidden = !fault;
}

function show(picture) {
  if (shown.picture) pace.steps += picture.steps - shown.picture.steps, pace.seconds += picture.seconds - shown.picture.seconds;
  pace.frames += 1;
  shown.picture = picture;
  requestAnimationFrame(draw);
  const now = performance.now(), passed = (now - pace.since) / 1000;
  if (passed < 1) return;
  $("pace").textContent = `${(pace.frames / passed).toFixed(0)} frames/s, ${(pace.steps / passed).toFixed(0)} steps/s, `
    + `${(pace.seconds / passed).toFixed(2)} × real time; t = ${picture.seconds.toFixed(1)} s`;
  Object.assign(pace, {frames: 0, steps: 0, seconds: 0, since: now});
}

async function start() {
  const kind = KINDS[shown.kind];
  await ready;
  await ask("play", false);
  refuse("");
  Object.assign(shown, {picture: null, measured: null});
  const overrides = kind.overrides({discs: Number($("discs").value), fill: Number($("fill").value) / 100});
  try {
    show(await ask("start", {text: SCENES[shown.kind], overrides}));
    await change("friction");
    await change("speed");
    tell();
    await ask("play", shown.playing);
  } catch (error) {
    refuse(error.message);
  }
}

async function change(name) {
  const kind = KINDS[shown.kind], value = Number($(name).value);
  const [call, values] = name === "friction" ? ["set_friction", kind.friction_of(value)] : kind.speed_of(value);
  try {
    await ask(call, values);
    refuse("");
  } catch (error) {
    refuse(error.message);
  }
}

function label() {
  $("friction-value").textContent = Number($("friction").value).toFixed(2);
  $("speed-value").textContent = `${$("speed").value} ${KINDS[shown.kind].speed.unit}`;
  $("fill-value").textContent = `${$("fill").value} %`;
  $("discs-value").textContent = $("discs").value;
}

function choose(name) {
  shown.kind = name;
  const kind = KINDS[name];
  for (const other of Object.keys(KINDS)) $(other).setAttribute("aria-pressed", String(other === name));
  Object.assign($("speed"), {min: kind.speed.min, max: kind.speed.max});
  $("speed").value = kind.speed.value;
  $("friction").value = kind.friction;
  $("fill-row").hidden = !kind.fill;
  $("about").textContent = kind.about;
  label();
  return start();
}

for (const name of Object.keys(KINDS)) $(name).onclick = () => choose(name);
for (const name of ["friction", "speed", "fill", "discs"]) $(name).oninput = label;
for (const name of ["friction", "speed"]) $(name).onchange = () => change(name);
for (const name of ["fill", "discs"]) $(name).onchange = start;
$("again").onclick = start;
$("play").onclick = () => {
  shown.playing = !shown.playing;
  $("play").textContent = shown.playing ? "Pause" : "Play";
  return ask("play", shown.playing);
};
window.addEventListener("resize", () => requestAnimationFrame(draw));
const begun = choose("drum");
