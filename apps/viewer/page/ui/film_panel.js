/** The panel "Camera path": records views as keys, plays them, and saves the path and films of it. */
import { cameraAt, completeKeys, turntable, withKey, withTime, withoutKey } from '../hands/camera_path.js';
import { roundCamera } from '../hands/pose.js';
import { button, group } from './controls.js';
import { h, resize, say } from './dom.js';
import { filmFiles } from './film_files.js';
import { icon } from './icons.js';
import { timeLine } from './time_line.js';

/**
 * @typedef {import('./interface.js').Ui} Ui
 * @typedef {import('../settings.js').Settings} Settings
 */

/** Seconds of a turntable. */
const TURN_SECONDS = 10;

/** @param {Ui} ui */
export function filmPanel(ui) {
  const { viewer, hands } = ui;
  const camera = () => roundCamera(viewer.camera());
  const seconds = h('input', { type: 'number', min: 0.1, max: 600, step: 0.1, value: 2, id: 'seconds-per-key', inputmode: 'decimal' });
  /** Milliseconds of the page at which the film began; 0: it does not play. */
  let began = 0;

  const record = () => {
    const pause = Number(seconds.value) > 0 ? Number(seconds.value) : 2, keys = withKey(viewer.get().path, camera(), pause);
    viewer.set({ path: keys }, 'ui');
    ui.toast(`Key ${keys.length} at ${keys[keys.length - 1].time} s`);
  };
  const turn = () => {
    stop();
    viewer.set({ path: turntable(camera(), TURN_SECONDS).map((key) => ({ ...key, eye: roundCamera({ ...viewer.camera(), eye: key.eye }).eye })) }, 'ui');
    ui.toast(`A turn of ${TURN_SECONDS} s around the point in the middle`);
  };
  const stop = () => {
    if (!began) return;
    began = 0;
    line.show(null);
    ui.refresh();
  };
  const play = () => {
    if (began) return stop();
    const keys = completeKeys(viewer.get().path, ui.home());
    if (keys.length < 2) return ui.toast('A film needs two keys or more');
    if (viewer.get().mode === 'walk') viewer.set({ mode: 'fly' }, 'ui');  // a walker would fall
    const start = keys[0].time, end = keys[keys.length - 1].time;
    const mine = (began = performance.now());
    const frame = (/** @type {number} */ now) => {
      if (began !== mine) return;
      const time = start + Math.max(0, now - mine) / 1000;
      viewer.set({ camera: cameraAt(keys, time) }, 'film');
      say(clock, `${Math.min(time, end).toFixed(1)} s`);
      line.show(Math.min(time, end));
      if (time < end) requestAnimationFrame(frame);
      else stop();
    };
    ui.refresh();
    requestAnimationFrame(frame);
  };
  hands.on('gesture', stop);

  const line = timeLine(ui, stop), files = filmFiles(ui, stop);
  const add = button('Add this view', record, { icon: 'add', primary: true, title: 'Key K', keys: 'K' });
  const turner = button('Turntable', turn, { icon: 'orbit', title: 'Replaces the path by a whole turn around the point in the middle' });
  const player = button('', play), clock = h('output', { class: 'clock' });
  const clear = button('Clear', () => { stop(); viewer.set({ path: [] }, 'ui'); });
  const list = h('ol', { class: 'list keys' });
  const newItem = (/** @type {number} */ i) => {
    const fly = () => {
      const { eye, target, up, fov } = completeKeys(viewer.get().path, ui.home())[i];
      hands.flyTo({ eye, target, up, fov });
    };
    const setTime = () => {
      if (Number.isFinite(time.valueAsNumber)) viewer.set({ path: withTime(viewer.get().path, i, time.valueAsNumber) }, 'ui');
    };
    const time = h('input', { type: 'number', step: 0.1, 'aria-label': `Seconds of key ${i + 1}`, inputmode: 'decimal', on: { change: setTime } });
    const remove = () => viewer.set({ path: withoutKey(viewer.get().path, i) }, 'ui');
    const go = button(`Key ${i + 1}`, fly, { title: 'Fly there' });
    go.className = 'item';
    return h('li', {}, go, time, h('span', {}, 's'),
      button(`Delete key ${i + 1}`, remove, { icon: 'trash', bare: true }));
  };
  const acts = h('div', { class: 'buttons' }, player, clear, clock);
  const film = group('', acts, line.element);
  return {
    element: h('div', {},
      group('', h('div', { class: 'buttons' }, add, turner), h('div', { class: 'row' }, h('label', { for: seconds.id }, 'Seconds to the next key'), seconds)),
      film, files.element,
      h('p', { class: 'hint' }, 'The saved path renders as a film in full quality:'),
      ui.command('voxdag render scene.vdag --path scene.path.json -o frame_%04d.png'), list),
    refresh(/** @type {Settings} */ settings) {
      const { path } = settings, name = began ? 'Stop' : 'Play';
      if (player.textContent !== name) player.replaceChildren(icon(name.toLowerCase()), name);
      clock.hidden = !began;
      film.hidden = path.length === 0;
      player.disabled = path.length < 2;
      resize(list, path.length, newItem);
      path.forEach((key, i) => {
        const time = list.children[i].querySelector('input');
        if (time && time.valueAsNumber !== key.time) time.value = String(key.time);
      });
      line.refresh();
      files.refresh(settings);
    },
    record,
    play,
  };
}
