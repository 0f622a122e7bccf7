// Two canvases that show the same instant: grains, and the mean flow with tracers.

const TRACER = "#ff5a1f", FRAMES = 25;  // in a second

async function startMotion() {
  const content = JSON.parse(document.getElementById("motion-content").textContent), part = name => document.getElementById("motion-" + name);
  const grains = await Run.of(content.particles, content.particles.data), tracers = await Run.of(content.tracers, content.tracers.data);
  const field = content.particles.fields[0], marked = new Set(content.marked), image = pictureOf(content.flow, field);
  const shown = { frame: 0 }, last = grains.frames.length - 1;
  const view = [-1.03, 1.03, -1.03, 0.55].map(part => part * content.radius);

  function prepared(canvas) {
    const pixel = Math.min(devicePixelRatio || 1, 2), camera = new Camera();
    const width = Math.round(canvas.clientWidth * pixel), height = Math.round(canvas.clientHeight * pixel);
    if (canvas.width !== width || canvas.height !== height) { canvas.width = width; canvas.height = height; }
    Object.assign(camera, { width, height });
    camera.show(view, 2 * pixel);
    const ctx = canvas.getContext("2d", { alpha: false });
    ctx.fillStyle = GROUND;
    ctx.fillRect(0, 0, width, height);
    return [ctx, camera, pixel];
  }

  function dots(ctx, camera, run, chosen) {
    const frame = run.frames[shown.frame];
    ctx.fillStyle = TRACER;
    ctx.beginPath();
    for (const g of chosen) {
      const x = camera.toX(run.x(frame, g)), y = camera.toY(run.z(frame, g)), r = run.radius[g] * camera.scale * 1.15;
      ctx.moveTo(x + r, y);
      ctx.arc(x, y, r, 0, 2 * Math.PI);
    }
    ctx.fill();
  }

  function draw() {
    let [ctx, camera, pixel] = prepared(part("left"));
    drawGrains(ctx, camera, grains, shown.frame, field, false);
    dots(ctx, camera, grains, marked);
    drawWalls(ctx, camera, grains, shown.frame, pixel);
    [ctx, camera, pixel] = prepared(part("right"));
    ctx.save();
    ctx.translate(camera.toX(0), camera.toY(0));
    ctx.rotate(content.flow.theta);
    const { x, z, axis_depth } = content.flow, s = camera.scale, dx = (x[1] - x[0]) / (x[2] - 1), dz = (z[1] - z[0]) / (z[2] - 1);
    ctx.drawImage(image, (x[0] - dx / 2) * s, -(z[1] + dz / 2 - axis_depth) * s, x[2] * dx * s, z[2] * dz * s);
    ctx.restore();
    dots(ctx, camera, tracers, tracers.radius.keys());
    drawWalls(ctx, camera, grains, shown.frame, pixel);
    const times = content.particles.time_s;
    part("scrub").value = shown.frame;
    part("clock").textContent = `${(times[shown.frame] - times[0]).toFixed(2)} s of ${(times[last] - times[0]).toFixed(2)} s`;
  }

  playBack(part, shown, last, FRAMES, draw);
  part("bar").style.background = `linear-gradient(to right, ${field.colours.join(",")})`;
  part("low").textContent = `below ${shortNumber(+field.low.toPrecision(1))}`;
  part("high").textContent = shortNumber(+field.high.toPrecision(2));
  new ResizeObserver(draw).observe(part("left"));
  draw();
}

// The mean flow as a picture with a pixel for each node, in the axes of the map.
function pictureOf(flow, field) {
  const picture = document.createElement("canvas"), levels = atob(flow.levels), wide = picture.width = flow.x[2], high = picture.height = flow.z[2];
  const pen = picture.getContext("2d"), data = pen.createImageData(wide, high);
  for (let row = 0; row < high; row++)
    for (let column = 0; column < wide; column++) {
      const level = levels.charCodeAt((high - 1 - row) * wide + column), at = 4 * (row * wide + column);
      if (level === 255) continue;
      for (let k = 0; k < 3; k++) data.data[at + k] = parseInt(field.colours[level].slice(1 + 2 * k, 3 + 2 * k), 16);
      data.data[at + 3] = 255;
    }
  pen.putImageData(data, 0, 0);
  return picture;
}

startMotion().catch(error => {
  const said = document.createElement("p");
  said.textContent = `What moves cannot be shown: ${error.message}`;
  document.getElementById("motion").replaceChildren(said);
});
