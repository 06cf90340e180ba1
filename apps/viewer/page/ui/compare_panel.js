/**
 * The panel "Compare": a second scene, in a viewer of its own over the first one's picture. It has the first one's settings
 * and camera, in world units, and is cut off at a line that is dragged.
 */
import { createViewer } from '../viewer.js';
import { button, group, segments } from './controls.js';
import { h, say } from './dom.js';
import { countText } from './numbers.js';
import { swipe } from './swipe.js';

/**
 * @typedef {import('./interface.js').Ui} Ui
 * @typedef {import('../viewer_types.js').Viewer} Viewer
 */

/** @param {Viewer} viewer */
const describe = ({ info }) => (info ? `${info.name || 'Scene'} · ${countText(info.resolution)}³ · ${countText(info.voxels)} voxels` : '');

/** @param {Ui} ui */
export function comparePanel(ui) {
  const { viewer } = ui;
  /** @type {Viewer | null} */
  let second = null;
  /** @type {import('./swipe.js').Shown} */
  let shown = 'both';
  const { layer, show } = swipe(viewer.canvas);
  const nameOf = (/** @type {Viewer | null} */ of) => (of?.info ? `${of.info.name || 'Scene'} · ${countText(of.info.resolution)}³` : '');
  const draw = () => show(second ? shown : 'first', [nameOf(viewer), nameOf(second)]);

  const follow = () => {
    const { measures, annotations, path, ...settings } = viewer.get(), shown = viewer.channel();
    // Both scenes have the scale of the legend.
    const channel = shown && { name: shown.name, range: shown.range[0] < shown.range[1] ? shown.range : null };
    second?.set({ ...settings, ...(channel && { channel }), camera: viewer.camera() }, 'compare');
  };
  for (const event of ['settings', 'info', 'level', 'channel']) viewer.on(event, follow);

  const remove = () => {
    second?.destroy();
    second = null;
    refresh();
  };
  /** Opens the second scene. @param {File} file */
  const load = async (file) => {
    const bytes = await file.arrayBuffer();
    remove();
    const opened = (second = createViewer({ container: layer, bytes, settings: { camera: viewer.camera() } }));
    opened.canvas.tabIndex = -1;
    opened.canvas.setAttribute('aria-hidden', 'true');
    for (const event of ['info', 'loaded']) opened.on(event, refresh);
    opened.on('note', (text) => ui.toast(`${file.name}: ${text}`, true));
    opened.on('error', ({ title, text }) => {
      ui.toast(`${file.name}: ${title}. ${text}`, true);
      if (!opened.info) remove();
    });
    follow();
    refresh();
  };
  const chosen = () => {
    if (chooser.files?.[0]) load(chooser.files[0]);
    chooser.value = '';
  };
  const chooser = h('input', { type: 'file', accept: '.vdag', class: 'offscreen', tabindex: -1, 'aria-label': 'File of the second scene', on: { change: chosen } });
  const which = segments({
    label: 'Show', options: [['both', 'Both'], ['first', 'First'], ['second', 'Second']], get: () => shown,
    set: (value) => { shown = value; draw(); },
  });
  const lines = [h('p', { class: 'hint' }), h('p', { class: 'hint' })];
  const controls = group('Show', which.element, ...lines, h('div', { class: 'buttons' }, button('Remove the second scene', remove)));
  const refresh = () => {
    [viewer, second].forEach((each, i) => say(lines[i], each ? `${['First', 'Second'][i]}: ${describe(each) || 'loading…'}` : ''));
    draw();
    controls.hidden = second === null;
    which.refresh(viewer.get());
  };
  return {
    element: h('div', {},
      group('', button('Choose a second scene…', () => chooser.click(), { icon: 'add', primary: true }), chooser, h('p', { class: 'hint' },
        'A .vdag file. Both scenes stand where their coordinates say. Drag the line in the picture; pointing and measuring use the first scene.')),
      controls),
    refresh,
    second: () => second,
  };
}
