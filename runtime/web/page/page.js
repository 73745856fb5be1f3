"use strict";
// The page: what the viewer asks for, and drawing it: at first one sample of each pixel, then all samples, a tile a
// frame, while nothing changes.
opaline.page = (() => {
  const kAcross = 3;  // samples a side of a pixel, as `opaline render` has
  const kTiles = [[1, 1], [0, 0], [2, 2], [2, 0], [0, 2], [1, 0], [1, 2], [0, 1], [2, 1]];  // the middle first
  const kSlowFrame = 60, kRest = 250;  // [ms]
  const at = id => document.getElementById(id);
  const canvas = at("canvas");
  const lights = new Map();  // by number, as read
  let asset, draw, state, home;
  let drawn = 0;             // of the current picture: a sample of all pixels, then tiles
  let chosen = null;         // exposure that the light shown asks for [EV]; null: not known yet
  let shown = { light: -1, turn: NaN, time: NaN, colors: null }, projected = null;
  let requested = false, moved = 0, lastFrame = 0, coarseness = 1;

  function say(text) { at("message").textContent = text; }

  function fail(error) {
    say(`This page cannot be shown: ${error.message ?? error}.`);
    throw error;
  }

  const hasTime = () => asset.layer !== null && !Layer.isStill(asset.layer);
  const numbers = text => text.split(",").map(Number);
  const areFinite = (values, count) => values.length === count && values.every(Number.isFinite);

  // From the address, after '#': what `opaline render` calls --light, --eye and so on.
  function readAddress() {
    const given = new URLSearchParams(location.hash.slice(1));
    const number = (name, otherwise, low, high) => {
      const value = parseFloat(given.get(name));
      return Number.isFinite(value) ? Math.min(high, Math.max(low, value)) : otherwise;
    };
    const point = name => {
      const values = numbers(given.get(name) ?? "");
      return areFinite(values, 3) ? values : null;
    };
    let view = { ...home, target: point("target") ?? home.target,
                 fov: number("fov", home.fov, 1, 170) };
    view.azimuth = number("azimuth", view.azimuth, -1e6, 1e6);
    view.elevation = number("elevation", view.elevation, -89.9, 89.9);
    view.distance = number("distance", view.distance, 1e-30, 1e30);
    if (point("eye") !== null) view = Camera.withEye(view, point("eye"));
    const colors = opaline.emitters.map(() => [1, 1, 1]);
    for (const text of given.getAll("emitter")) {
      const equals = text.lastIndexOf("="), emitter = opaline.emitters.indexOf(text.slice(0, equals));
      const factors = numbers(text.slice(equals + 1));
      if (emitter >= 0 && areFinite(factors, 3)) colors[emitter] = factors.map(f => Math.max(f, 0));
    }
    const light = Math.max(0, opaline.lights.indexOf(given.get("light")));
    return { view, light, turn: number("rotate", 0, -1e6, 1e6),
             time: hasTime() ? number("time", 0, -1e9, 1e9) : 0, exposure: number("exposure", null, -64, 64), colors };
  }

  // So that the address can be kept or passed on.
  let addressTimer = 0;
  function writeAddress() {
    clearTimeout(addressTimer);
    addressTimer = setTimeout(() => {
      const { view, light, turn, time, exposure, colors } = state, digits = x => String(+x.toPrecision(6));
      const parts = new URLSearchParams({
        light: opaline.lights[light], rotate: digits(turn),
        azimuth: digits(view.azimuth), elevation: digits(view.elevation),
        distance: digits(view.distance), target: view.target.map(digits).join(",") });
      if (exposure !== null) parts.set("exposure", digits(exposure));
      if (time !== 0) parts.set("time", digits(time));
      if (view.fov !== home.fov) parts.set("fov", digits(view.fov));
      colors.forEach((color, e) => {
        if (color.some(c => c !== 1)) {
          parts.append("emitter", `${opaline.emitters[e]}=${color.map(digits).join(",")}`);
        }
      });
      try { history.replaceState(null, "", `#${parts}`); } catch { /* some browsers refuse files */ }
    }, 300);
  }

  function request() {
    if (!requested) requestAnimationFrame(tick);
    requested = true;
  }

  function change(parts) {
    Object.assign(state, parts);
    drawn = 0;
    moved = performance.now();
    showValues();
    writeAddress();
    request();
  }

  async function lightOf(number) {
    if (!lights.has(number)) {
      const owner = `light-${number}`;
      await opaline.load(`${owner}.js`);
      lights.set(number, Light.read(opaline.arraysOf(owner)));
    }
    return lights.get(number);
  }

  // Brings the light of rows up to date; false while its script is being read.
  function relight() {
    const { light, turn, time, colors } = state;
    if (!lights.has(light)) {
      lightOf(light).then(() => { drawn = 0; request(); }).catch(fail);
      return false;
    }
    if (shown.light !== light) draw.setLight(lights.get(light));
    const isNew = shown.light !== light || shown.turn !== turn || shown.time !== time;
    if (isNew) projected = draw.project(turn * Math.PI / 180, time);
    if (isNew || shown.colors !== colors) {
      draw.relight(projected, colors);
      chosen = null;
    }
    shown = { light, turn, time, colors };
    return true;
  }

  const frameOf = (width, height) => Camera.frame(state.view, asset.camera, width / height);
  const seenBy = () => ({ turn: state.turn * Math.PI / 180, colors: state.colors });

  // Given, or chosen from the picture once light has changed: turning the view changes none.
  function exposureOf(width, height) {
    if (state.exposure !== null) return state.exposure;
    if (chosen === null) {
      chosen = draw.chooseExposure(frameOf(width, height), seenBy(), width, height);
      showExposure();
    }
    return chosen;
  }

  // Step 0: one sample of each pixel; then tiles, each with as many samples as that.
  function drawStep(step, width, height) {
    const tileWidth = Math.ceil(width / kAcross), tileHeight = Math.ceil(height / kAcross);
    draw.resize(width, height, tileWidth, tileHeight, kAcross);
    const frame = frameOf(width, height), seen = seenBy();
    if (step === 0) {
      draw.drawTile(frame, seen, Draw.whole(width, height));
      return;
    }
    const [column, row] = kTiles[step - 1], x = column * tileWidth, y = row * tileHeight;
    const tile = { x, y, width: Math.min(tileWidth, width - x), height: Math.min(tileHeight, height - y), across: kAcross };
    if (tile.width > 0 && tile.height > 0) draw.drawTile(frame, seen, tile);
  }

  // Devices that are too slow draw fewer pixels while something moves.
  function tick(now) {
    requested = false;
    try {
      if (!relight()) return;
    } catch (error) {
      fail(error);
      return;
    }
    const isMoving = now - moved < kRest;
    if (isMoving && now - lastFrame > kSlowFrame && now - lastFrame < 1000) {
      coarseness = Math.min(coarseness * 2, 4);
      drawn = 0;
    }
    lastFrame = now;
    const ratio = Math.min(window.devicePixelRatio || 1, 2);
    const width = Math.max(1, Math.round(canvas.clientWidth * ratio));
    const height = Math.max(1, Math.round(canvas.clientHeight * ratio));
    if (canvas.width !== width || canvas.height !== height) {
      canvas.width = width;
      canvas.height = height;
      drawn = 0;
    }
    const coarse = isMoving ? coarseness : 1;
    if (!isMoving && coarseness > 1) {
      coarseness = 1;
      drawn = 0;
    }
    try {
      const exposure = exposureOf(width, height);
      // Tiles wait until nothing changes.
      if (drawn === 0 || (!isMoving && drawn <= kTiles.length)) {
        drawStep(drawn, Math.ceil(width / coarse), Math.ceil(height / coarse));
        ++drawn;
      }
      draw.present(exposure);
    } catch (error) {
      fail(error);
      return;
    }
    say("");
    if (drawn <= kTiles.length || coarse > 1) request();
  }

  // All samples of a picture of that size, as the address or the viewer has it.
  async function takePicture(width, height) {
    await lightOf(state.light);
    relight();
    const exposure = exposureOf(width, height);
    for (let step = 1; step <= kTiles.length; ++step) drawStep(step, width, height);
    const pixels = draw.readPixels(exposure);
    drawn = 0;
    request();
    return { width, height, pixels };
  }

  async function savePicture() {
    const { width, height, pixels } = await takePicture(canvas.width, canvas.height);
    const flat = document.createElement("canvas");
    flat.width = width;
    flat.height = height;
    flat.getContext("2d").putImageData(new ImageData(pixels, width, height), 0, 0);
    flat.toBlob(blob => {
      const link = document.createElement("a");
      link.href = URL.createObjectURL(blob);
      link.download = `${opaline.title}.png`;
      link.click();
      URL.revokeObjectURL(link.href);
    });
  }

  function turnView(degreesX, degreesY) {
    const { view } = state;
    change({ view: { ...view, azimuth: view.azimuth + degreesX,
                     elevation: Math.min(89.9, Math.max(-89.9, view.elevation + degreesY)) } });
  }

  function moveCloser(factor) {
    change({ view: { ...state.view, distance: state.view.distance * factor } });
  }

  // The target follows the pointer: [CSS pixels].
  function moveTarget(x, y) {
    const { view } = state, frame = Camera.frame(view, asset.camera, 1);
    const size = 2 * view.distance * frame.tangent[1] / canvas.clientHeight;
    const move = Vector.add(Vector.times(-x * size, frame.right), Vector.times(y * size, frame.up));
    change({ view: { ...view, target: Vector.add(view.target, move) } });
  }

  function listenToPointers() {
    const pointers = new Map();
    const spread = () => {
      const [a, b] = [...pointers.values()];
      return Math.max(1, Math.hypot(a.x - b.x, a.y - b.y));
    };
    canvas.addEventListener("pointerdown", event => {
      canvas.setPointerCapture(event.pointerId);
      pointers.set(event.pointerId, { x: event.clientX, y: event.clientY });
    });
    canvas.addEventListener("pointermove", event => {
      const last = pointers.get(event.pointerId);
      if (last === undefined) return;
      const x = event.clientX - last.x, y = event.clientY - last.y;
      const before = pointers.size === 2 ? spread() : 1;
      pointers.set(event.pointerId, { x: event.clientX, y: event.clientY });
      if (pointers.size === 2) {
        moveCloser(before / spread());
        moveTarget(x / 2, y / 2);
      } else if (event.buttons & 2 || event.shiftKey) {
        moveTarget(x, y);
      } else {
        turnView(-0.3 * x, 0.3 * y);
      }
    });
    for (const end of ["pointerup", "pointercancel"]) {
      canvas.addEventListener(end, event => pointers.delete(event.pointerId));
    }
    canvas.addEventListener("contextmenu", event => event.preventDefault());
    canvas.addEventListener("wheel", event => {
      event.preventDefault();
      const lines = event.deltaMode === 1 ? 30 : 1;
      moveCloser(Math.exp(0.0015 * lines * Math.max(-300, Math.min(300, event.deltaY))));
    }, { passive: false });
    canvas.addEventListener("keydown", event => {
      const keys = { ArrowLeft: () => turnView(-5, 0), ArrowRight: () => turnView(5, 0),
                     ArrowUp: () => turnView(0, 5), ArrowDown: () => turnView(0, -5),
                     "+": () => moveCloser(0.9), "-": () => moveCloser(1 / 0.9) };
      if (keys[event.key] === undefined) return;
      event.preventDefault();
      keys[event.key]();
    });
  }

  // Factors of an emitter on a slider: 0, then halvings and doublings of what was authored.
  const factorOf = step => step <= -6 ? 0 : 2 ** step;
  const stepOf = color => Math.max(...color) > 0 ? Math.log2(Math.max(...color)) : -6;

  function makeEmitterSliders() {
    opaline.emitters.forEach((name, e) => {
      const label = document.createElement("label"), slider = document.createElement("input");
      const output = document.createElement("output");
      output.id = `emitter-${e}`;
      Object.assign(slider, { type: "range", min: -6, max: 4, step: 0.1, id: `slider-${e}` });
      label.append(`${name} `, output, slider);
      at("emitters").append(label);
      slider.addEventListener("input", () => {
        const colors = state.colors.slice(), factor = factorOf(slider.valueAsNumber);
        const most = Math.max(...colors[e]);  // its hue stays
        colors[e] = most > 0 ? colors[e].map(c => c / most * factor) : [factor, factor, factor];
        change({ colors });
      });
    });
  }

  // What a light that `--light` names is called here; files keep their names.
  function labelOf(name) {
    const words = { studio: "Studio", white: "White from everywhere", black: "Its own lamps alone" };
    const [kind, first, second] = name.split(/[:,]/);
    if (kind === "sky" && second) return `Sky, sun ${second}° high`;
    if (kind === "sun" && second) return `Sun alone, ${second}° high`;
    return first === undefined ? words[kind] ?? name : name;
  }

  const labelOfTime = seconds =>
      Math.abs(seconds) < 120 ? `${Math.round(seconds)} s` : `${(seconds / 60).toFixed(1)} min`;

  function makeControls() {
    document.title = at("title").textContent = opaline.title;
    at("light").append(...opaline.lights.map((name, i) => new Option(labelOf(name), i)));
    makeEmitterSliders();
    at("time").closest("label").hidden = !hasTime();
    if (hasTime()) Object.assign(at("time"), { max: Layer.spanOf(asset.layer), step: Layer.spanOf(asset.layer) / 720 });
    at("light").addEventListener("change", () => change({ light: +at("light").value }));
    at("turn").addEventListener("input", () => change({ turn: at("turn").valueAsNumber }));
    at("time").addEventListener("input", () => change({ time: at("time").valueAsNumber }));
    at("exposure").addEventListener("input", () => change({ exposure: at("exposure").valueAsNumber }));
    at("reset").addEventListener("click", () => {
      change({ view: home, turn: 0, time: 0, exposure: null, colors: opaline.emitters.map(() => [1, 1, 1]) });
    });
    at("save").addEventListener("click", () => savePicture().catch(fail));
    if (window.innerWidth < 640) at("panel").open = false;
  }

  function showValues() {
    const turn = ((state.turn + 180) % 360 + 360) % 360 - 180;
    at("light").value = state.light;
    at("turn").value = turn;
    at("turn-value").textContent = `${Math.round(turn)}°`;
    at("time").value = state.time;
    at("time-value").textContent = labelOfTime(state.time);
    showExposure();
    state.colors.forEach((color, e) => {
      const step = stepOf(color);
      at(`slider-${e}`).value = step;
      at(`emitter-${e}`).textContent = `× ${+Math.max(...color).toPrecision(2)}`;
    });
  }

  function showExposure() {
    const exposure = state.exposure ?? chosen ?? 0;
    at("exposure").value = exposure;
    at("exposure-value").textContent = `${exposure > 0 ? "+" : ""}${exposure.toFixed(1)} EV`;
  }

  async function start() {
    await opaline.load("asset-data.js");
    asset = Asset.read(opaline.arraysOf("asset"));
    home = Camera.framing(asset.camera, canvas.clientWidth / canvas.clientHeight);
    state = readAddress();
    makeControls();
    draw = Draw.make(canvas, asset);
    canvas.addEventListener("webglcontextlost", () => {
      say("The graphics of this device have dropped the page: load it again.");
    });
    showValues();
    listenToPointers();
    new ResizeObserver(request).observe(canvas);
    window.addEventListener("hashchange", () => change(readAddress()));
    request();
  }

  const ready = start().catch(fail);
  return { ready, takePicture };
})();
