/** The panel "Camera path": records views as keys, plays them, and saves the file of `render --path`. */
import { cameraAt, completeKeys, pathToJson, withKey, withTime, withoutKey } from '../hands/camera_path.js';
import { roundCamera } from '../hands/pose.js';
import { button, group } from './controls.js';
import { download, h, resize, say } from './dom.js';

/**
 * @typedef {import('./interface.js').Ui} Ui
 * @typedef {import('../settings.js').Settings} Settings
 */

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
  const stop = () => {
    if (!began) return;
    began = 0;
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
      if (time < end) requestAnimationFrame(frame);
      else stop();
    };
    ui.refresh();
    requestAnimationFrame(frame);
  };
  hands.on('gesture', stop);

  const add = button('Add this view', record, { icon: 'add', primary: true, title: 'Key K', keys: 'K' });
  const player = button('Play', play, { icon: 'play' });
  const clock = h('output', { class: 'clock' });
  const save = button('Save path', () => {
    download(`${ui.name()}.path.json`, new Blob([pathToJson(viewer.get().path, viewer.get().sun.direction)], { type: 'application/json' }));
  });
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
  const acts = h('div', { class: 'buttons' }, player, save, clear, clock);
  return {
    element: h('div', {},
      group('', add, h('div', { class: 'row' }, h('label', { for: seconds.id }, 'Seconds to the next key'), seconds)),
      list, acts,
      h('p', { class: 'hint' }, 'The saved path renders as a film in full quality:'),
      ui.command('voxdag render scene.vdag --path scene.path.json -o frame_%04d.png')),
    refresh(/** @type {Settings} */ { path }) {
      say(player.lastChild ?? player, began ? 'Stop' : 'Play');
      clock.hidden = !began;
      acts.hidden = path.length === 0;
      player.disabled = path.length < 2;
      resize(list, path.length, newItem);
      path.forEach((key, i) => {
        const time = list.children[i].querySelector('input');
        if (time && time.valueAsNumber !== key.time) time.value = String(key.time);
      });
    },
    record,
    play,
  };
}
