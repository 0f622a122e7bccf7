// The engine's thread: steps the scene, and sends pictures and measured numbers to the page.
"use strict";

function work(engine) {
  const PICTURES = 25;        // a second, at most
  const MEASURE_EVERY = 500;  // ms
  let module, scene, playing = false, stepsAPicture = 1, stepTime = 0.001, due = 0, measureAt = 0;

  // What the page may ask for.
  const answers = {
    start({text, overrides}) {
      if (scene) scene.delete();
      scene = undefined;
      scene = new module.LiveScene(text, overrides.join("\n"));
      [stepTime, stepsAPicture, measureAt] = [scene.step_time(), 1, 0];
      return scene.picture();
    },
    play(on) {
      playing = on;
      if (on) next();
    },
    step: count => scene.step(count),
    set_friction: values => scene.set_friction(...values),
    turn: values => scene.turn(...values),
    shear: values => scene.shear(...values),
    step_time: () => scene.step_time(),
    places: () => ({x: scene.x(), z: scene.z()}),
    measured: () => scene.measured(),
    picture: () => scene.picture(),
  };

  function next() {
    clearTimeout(due);
    due = setTimeout(frame, 0);
  }

  // As many steps as there is time for, but no more than the scene's own clock has.
  function frame() {
    if (!playing || !scene) return;
    const begun = performance.now();
    try {
      scene.step(stepsAPicture);
      const took = performance.now() - begun;
      const fit = Math.floor(stepsAPicture * 0.9 * 1000 / PICTURES / Math.max(took, 0.1));
      const most = Math.round(1 / PICTURES / stepTime);
      const least = Math.floor(stepsAPicture / 2), twice = 2 * stepsAPicture;
      stepsAPicture = Math.max(1, Math.min(most, twice, Math.max(least, fit)));
      const picture = scene.picture();
      postMessage({picture}, [picture.grains.buffer]);
      if (begun > measureAt) {
        postMessage({measured: scene.measured()});
        measureAt = performance.now() + MEASURE_EVERY;
      }
    } catch (error) {
      playing = false;
      postMessage({fault: words(error)});
      return;
    }
    due = setTimeout(frame, Math.max(0, begun + 1000 / PICTURES - performance.now()));
  }

  const words = error => error.message ?? String(error);

  onmessage = ({data: {id, name, value}}) => {
    try {
      postMessage({id, value: answers[name](value)});
    } catch (error) {
      postMessage({id, fault: words(error)});
    }
  };
  engine().then(made => {
    module = made;
    postMessage({ready: true});
  }, error => postMessage({fault: words(error)}));
}
