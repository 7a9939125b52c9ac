// The bar; then all is built, its animation loaded last.
function controls() {
  const animator = viewer.animator;
  const signs = { Pause: "M1 0h3.6v12H1zM7.4 0H11v12H7.4z", Play: "M1 0l10.5 6L1 12z" };
  const slider = find("time"), clock = find("clock"), speed = find("speed");
  const button = find("play"), chapter = find("chapter");
  slider.max = duration;
  slider.addEventListener("input", () => {
    animator.pause();
    animator.seek(Number(slider.value));
    animator.display_progress(Number(slider.value));
  });
  button.addEventListener("click", () =>
    animator.playing ? animator.pause() : animator.play());
  speed.addEventListener("change", () => {
    animator.mixer.timeScale = Number(speed.value);
  });
  const show = () => {
    requestAnimationFrame(show);
    const text = `${animator.time.toFixed(2)} / ${duration.toFixed(2)} s`;
    if (clock.value !== text) clock.value = text;
    const begun = scene.chapters.filter((part) => part.begin <= animator.time + 1e-3);
    const name = begun.length ? begun[begun.length - 1].name : "";
    if (chapter.textContent !== name) chapter.textContent = name;
    if (document.activeElement !== slider || animator.playing)
      slider.value = animator.time;
    const next = animator.playing ? "Pause" : "Play";
    if (button.dataset.sign === next) return;
    button.dataset.sign = next;
    button.setAttribute("aria-label", next);
    find("sign").setAttribute("d", signs[next]);
  };
  show();
}

let viewer;
try {
  viewer = new MeshCat.Viewer(find("pane"));
} catch (error) {
  find("pane").innerHTML = '<p id="failure">No replay: this browser has no WebGL.</p>';
  return;
}
surround();
scene.bodies.forEach((body, index) => place(bodyPath(index), {
  position: body.position, quaternion: body.quaternion }));
scene.geoms.forEach(addGeom);
scene.soft.forEach(addSoft);
scene.traces.forEach(addTrace);
scene.markers.forEach(addMarker);
scene.arrows.forEach(addArrow);
look();
const render = viewer.render.bind(viewer);
viewer.render = () => {
  for (const update of beforeRender) update(viewer.animator.time);
  render();
};
clips.push({ path: ["Clock"], clip: { name: "clock", fps: 1, tracks: [{
  name: ".position", type: "vector3", times: [0, duration], values: [0, 0, 0, 0, 0, 0] }] } });
viewer.set_animation(clips, { play: true, repetitions: Infinity });
controls();
