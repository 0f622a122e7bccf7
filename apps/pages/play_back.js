// Play button and slider of what moves: shown.frame goes from 0 to last, so many frames in a second.
function playBack(part, shown, last, frames, draw) {
  let playing = false, since = 0;

  function step(now) {
    if (!playing) return;
    const steps = Math.floor((now - since) * frames / 1000);
    if (steps > 0) {
      since += steps * 1000 / frames;
      shown.frame = (shown.frame + Math.min(steps, frames)) % (last + 1);
      draw();
    }
    requestAnimationFrame(step);
  }

  part("play").addEventListener("click", () => {
    playing = !playing;
    since = performance.now();
    part("play").textContent = playing ? "Pause" : "Play";
    requestAnimationFrame(step);
  });
  part("scrub").addEventListener("input", () => { shown.frame = +part("scrub").value; draw(); });
}
