// Two canvases that show the same instant of both sides of a pair: a field, and the surfaces of both.

const SURFACES = ["#0072b2", "#d55e00"], FRAMES = 12;  // in a second

async function startPair() {
  const content = JSON.parse(document.getElementById("pair-content").textContent), part = name => document.getElementById("pair-" + name);
  const { x, z, times, places } = content, wide = x[2], high = z[2], last = times.length - 1;
  const dx = (x[1] - x[0]) / Math.max(1, wide - 1), dz = (z[1] - z[0]) / Math.max(1, high - 1);
  const shown = { frame: 0, field: content.fields[0] };
  for (const field of content.fields) {
    field.bytes = await Promise.all(field.sides.map(inflated));
    field.pens = field.colours.map(colour => [1, 3, 5].map(k => parseInt(colour.slice(k, k + 2), 16)));
    part("field").add(new Option(field.name === "p" ? "pressure" : field.name, field.name));
  }
  const picture = document.createElement("canvas"), pen = picture.getContext("2d");
  picture.width = wide;
  picture.height = high;
  const pixels = pen.createImageData(wide, high);

  part("left").closest(".sides").style.flexDirection = wide * dx > 3 * high * dz ? "column" : "";

  function paint(side) {
    const bytes = shown.field.bytes[side], from = shown.frame * wide * high;
    for (let row = 0; row < high; row++)
      for (let column = 0; column < wide; column++) {
        const level = bytes[from + (high - 1 - row) * wide + column], at = 4 * (row * wide + column);
        const colour = level === 255 ? [255, 255, 255] : shown.field.pens[level];
        for (let k = 0; k < 3; k++) pixels.data[at + k] = colour[k];
        pixels.data[at + 3] = 255;
      }
    pen.putImageData(pixels, 0, 0);
  }

  function draw() {
    for (const side of [0, 1]) {
      const canvas = part(["left", "right"][side]), pixel = Math.min(devicePixelRatio || 1, 2), ctx = canvas.getContext("2d");
      const width = Math.round(canvas.clientWidth * pixel), scale = width / (wide * dx), height = Math.round(high * dz * scale);
      canvas.width = width;
      canvas.height = height;
      canvas.style.aspectRatio = `${width} / ${height}`;
      paint(side);
      ctx.imageSmoothingEnabled = false;
      ctx.drawImage(picture, 0, 0, width, height);
      // The own surface drawn through, the other side's dashed.
      for (const other of [1 - side, side]) {
        ctx.strokeStyle = SURFACES[other];
        ctx.lineWidth = 1.5 * pixel;
        ctx.setLineDash(other === side ? [] : [4 * pixel, 4 * pixel]);
        ctx.beginPath();
        let down = false;
        content.surfaces[other][shown.frame].forEach((top, i) => {
          if (top === null) { down = false; return; }
          ctx[down ? "lineTo" : "moveTo"]((places[i] - x[0] + dx / 2) * scale, height - (top - z[0] + dz / 2) * scale);
          down = true;
        });
        ctx.stroke();
      }
    }
    part("scrub").value = shown.frame;
    part("clock").textContent = `${times[shown.frame].toFixed(1)} of ${times[last].toFixed(1)} √(d/g)`;
    part("bar").style.background = `linear-gradient(to right, ${shown.field.colours.join(",")})`;
    part("high").textContent = `${shown.field.top.toPrecision(2)} ${shown.field.unit}`;
  }

  playBack(part, shown, last, FRAMES, draw);
  part("field").addEventListener("change", () => { shown.field = content.fields.find(field => field.name === part("field").value); draw(); });
  addEventListener("resize", draw);
  draw();
}

startPair().catch(error => {
  const said = document.createElement("p");
  said.textContent = `What moves cannot be shown: ${error.message}`;
  document.getElementById("motion").replaceChildren(said);
});
