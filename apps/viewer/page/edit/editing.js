/** The panel "Edit": brushes on the picture, undo and redo, and files that are saved. */
import { mostTexels } from '../gpu/long_texture.js';
import { isTyping } from '../hands/keys.js';
import { length, sub } from '../math.js';
import { NO_NODE } from '../trace.js';
import { button, choice, group, refreshAll, segments, slider, textField } from '../ui/controls.js';
import { h, say } from '../ui/dom.js';
import { materialName } from '../ui/materials_panel.js';
import { lengthText } from '../ui/numbers.js';
import { Stroke } from './brush.js';
import { EditClient, Refused } from './client.js';
import { PageEditor, serverEditor } from './editors.js';
import { floorHit } from './floor.js';
import { makePreview } from './preview.js';
import { applyUpdate } from './update.js';

/** @typedef {import('../ui/interface.js').Ui} Ui */
/** @typedef {import('./brush.js').Brush} Brush */

/** The first radius, and the largest one, in diagonals of the scene; the factor of a key on the radius. */
const FIRST_RADIUS = 0.02, MOST_RADIUS = 0.25, RADIUS_STEP = 1.25;

/** @type {import('../ui/interface.js').Extra['help']} */
const HELP = ['Edit', [
  ['T', 'brush: drag over the surface'],
  ['Right drag · two fingers', 'move the camera while the brush is on'],
  ['[ ]', 'smaller, larger brush'],
  ['Ctrl Z', 'undo a stroke'],
  ['Ctrl Shift Z', 'redo it'],
]];

/**
 * Makes the panel and what belongs to it. The server edits its scene; without one, the program in the page edits whatever it shows.
 * @param {Ui} ui @param {string | null} secret  Of the page's address, from `voxdag view --edit`. @returns {import('../ui/interface.js').Extra}
 */
export function makeEditing(ui, secret) {
  const { viewer } = ui, voxel = () => viewer.info?.voxelSize ?? 1, page = secret === null ? new PageEditor() : null;
  /** @type {Brush} */
  const brush = { verb: 'remove', shape: 'ball', radius: 0, color: '#d04a2b', material: null };
  let undos = 0, redos = 0, root = 0, version = '', first = '', saved = '', fileName = '', isOpen = false, canBegin = false, why = 'The scene is loading…';
  /** Returns the brush as far as the scene has colours and materials. @returns {Brush} */
  const usable = () => ({ ...brush, color: viewer.info?.hasColors ? brush.color : null, material: viewer.info?.materials ? brush.material : null });

  const fail = (/** @type {Error} */ error) => {
    // The server and this page may differ from now on.
    if (!(error instanceof Refused) || error.status !== 400) stop(error.message);
    ui.toast(error.message, true);
    ui.refresh();
  };
  const client = new EditClient(page ?? serverEditor(secret ?? ''), (update, goesOn) => {
    ({ undos, redos } = update);
    viewer.change((memory, textures) => applyUpdate(update, memory, textures, mostTexels(textures.gl)), goesOn);
    root = update.version.root;
    version = Object.values(update.version).join();
    if (!isOpen) first = saved = version;
    if (root === NO_NODE && !isOpen) brush.verb = 'add';
    const begins = page !== null && !isOpen;
    isOpen = true;
    ui.refresh();
    if (begins) tool.toggle();
  }, fail);
  const stop = (/** @type {string} */ reason) => {
    isOpen = canBegin = false;
    why = reason;
    page?.close();
    tool.stop();
    ui.refresh();
  };

  const preview = makePreview(ui, usable);
  /** Returns the place of a brush that meets no surface: if it adds to a scene that has none, or had none in its file. @param {number} x @param {number} y @param {number} version */
  const floor = (x, y, version) => {
    const { info } = viewer, ray = ui.overlay.projection?.ray(x, y), isBare = info?.voxels === 0 || version === NO_NODE;
    return brush.verb === 'add' && info && isBare && ray ? floorHit(info, ray.origin, ray.direction) : null;
  };
  const tool = ui.tool({
    hint: () => ({ remove: 'Drag to remove voxels', add: 'Drag to add voxels', paint: 'Drag to paint' })[brush.verb] + '. The right button moves the camera',
    click() {},
    hover: (hit, x, y) => preview.at(hit ?? floor(x, y, root)),
    drag(x, y) {
      const before = root, { overlay } = ui;
      /** Whether the stroke is on the floor, as its first place is; null before. @type {boolean | null} */
      let isOnFloor = null;
      const pick = async (/** @type {number} */ px, /** @type {number} */ py) => {
        const surface = isOnFloor === true ? null : await viewer.pick(px, py, before);
        const hit = surface ?? (isOnFloor === false ? null : floor(px, py, before));
        isOnFloor ??= hit === null ? null : surface === null;
        preview.at(hit);
        return hit;
      };
      const stroke = new Stroke(usable(), pick, (point) => overlay.projection?.pixel(point) ?? 1, (line, isFirst) => client.draw(line, isFirst), voxel());
      client.isDrawing = true;
      stroke.move(x, y);
      return {
        move: (toX, toY) => stroke.move(toX, toY),
        end() {
          // The last answer of the stroke may have come already: then the picture does not wait for more.
          stroke.work.then(() => {
            client.isDrawing = false;
            if (!client.isBusy) viewer.change(() => {}, false);
          });
        },
      };
    },
    end: () => preview.at(null),
  });
  /** Gives the scene to the program in the page. */
  const begin = () => ui.job('Open for edits', async ({ signal }) => {
    await page?.begin(await viewer.scene(), `${ui.name()}.vdag`, signal);
    canBegin = false;
    client.open();
  });
  const undo = () => { if (isOpen && undos > 0) client.undo(); };
  const redo = () => { if (isOpen && redos > 0) client.redo(); };
  const resize = (/** @type {number} */ factor) => {
    brush.radius = Math.min(Math.max(brush.radius * factor, voxel() / 2), MOST_RADIUS * diagonal());
    ui.refresh();
    ui.overlay.redraw();
  };
  const diagonal = () => (viewer.info ? length(sub(viewer.info.bounds.high, viewer.info.bounds.low)) : 1);

  const save = async () => {
    const name = fileName.trim();
    for (const replaces of [false, true])
      try {
        const file = await client.save(name, replaces);
        saved = version;
        return ui.toast(`Saved ${file}`);
      } catch (error) {
        if (!(error instanceof Refused) || error.status !== 412) return ui.toast(/** @type {Error} */ (error).message, true);
        if (!window.confirm(`${error.message}. Replace it?`)) return;
      }
  };

  // The panel.
  const verbs = segments({
    label: 'Brush', options: [['remove', 'Remove'], ['add', 'Add'], ['paint', 'Paint']],
    get: () => brush.verb, set(verb) { brush.verb = verb; changed(); },
  });
  const shapes = segments({
    label: 'Shape', options: [['ball', 'Ball'], ['box', 'Box'], ['capsule', 'Stroke']],
    get: () => brush.shape, set(shape) { brush.shape = shape; changed(); },
  });
  const changed = () => {
    if (tool.active) { tool.stop(); tool.toggle(); }
    ui.refresh();
  };
  const radius = slider({
    label: 'Radius', min: 0, max: 1, to: Math.log2, from: (x) => 2 ** x, text: (x) => lengthText(x, voxel()),
    get: () => brush.radius, set(value) { brush.radius = value; ui.overlay.redraw(); },
  });
  const color = h('input', { type: 'color', value: brush.color, on: { input: () => { brush.color = color.value; ui.overlay.redraw(); } } });
  const colorRow = h('label', { class: 'row' }, 'Colour', color);
  /** @type {import('../ui/controls.js').Control | null} */
  let materials = null;
  const materialPart = h('div', {}), note = h('p', { class: 'hint' });
  const start = button('Brush', () => tool.toggle(), { icon: 'edit', primary: true, title: 'Drag over the surface (key T)', keys: 'T' });
  const back = button('Undo', undo, { icon: 'undo', title: 'Ctrl Z', keys: 'Control+Z' }), forth = button('Redo', redo, { icon: 'redo', title: 'Ctrl Shift Z', keys: 'Control+Shift+Z' });
  const file = textField({ label: 'File', most: 200, hint: 'In the folder of the scene', get: () => fileName, set: (name) => { fileName = name; } });
  const saver = button('Save as', save, { icon: 'share' }), beginner = button('Edit this scene', begin, { icon: 'edit', primary: true });
  const body = h('div', {}, group('', verbs.element, shapes.element, radius.element, colorRow, materialPart, start),
    group('', h('div', { class: 'buttons' }, back, forth)), page ? '' : group('', file.element, h('div', { class: 'buttons' }, saver)));

  window.addEventListener('keydown', (event) => {
    if (isTyping(event) || event.altKey) return;
    const key = event.key.toLowerCase(), isCommand = event.ctrlKey || event.metaKey;
    const act = isCommand ? (key === 'z' ? (event.shiftKey ? redo : undo) : key === 'y' ? redo : null)
      : key === '[' ? () => resize(1 / RADIUS_STEP) : key === ']' ? () => resize(RADIUS_STEP) : null;
    if (!act) return;
    event.preventDefault();
    act();
  });
  viewer.on('loaded', () => {
    const { info } = viewer;
    if ((!page && viewer.file !== null) || !info) return;
    if (viewer.statistics().levelsLoaded < info.levels && info.voxels > 0) return stop('The scene is too large for the graphics card to be edited.');
    if (page) {
      if (info.voxels === 0) return stop('The scene has no voxels.');
      canBegin = true;
      why = 'Brushes add, remove and paint voxels. Edits stay in this page until the scene is saved.';
      return ui.refresh();
    }
    client.open();
    client.fileName().then((name) => { fileName = name; ui.refresh(); }, fail);
  });
  viewer.on('opened', () => stop(page ? 'The scene is loading…' : 'Only the scene of the server can be edited.'));
  window.addEventListener('beforeunload', (event) => {
    if (page && isOpen && version !== saved) event.preventDefault();
  });

  return {
    help: HELP,
    act: () => { if (isOpen) tool.toggle(); else if (canBegin) begin(); },
    async scene() {
      if (!isOpen || version === first) return null;
      if (!page) throw new Error('the panel Edit saves scenes with edits');
      const now = version;
      await client.save('scene', true);
      saved = now;
      return page.saved;
    },
    panel: {
      element: h('div', {}, body, note, beginner),
      refresh(settings) {
        const { info } = viewer, most = MOST_RADIUS * diagonal();
        body.hidden = !isOpen;
        beginner.hidden = !canBegin;
        say(note, !isOpen ? why : brush.verb === 'paint' && !info?.hasColors && !info?.materials ? 'The file has no colours: voxdag build --color stores them.'
          : root === NO_NODE ? 'There are no voxels: Add draws on the floor of the grid.'
            : page ? 'Edits stay in this page: Save and share saves them. T ends the brush.' : 'Edits stay with the server until they are saved. T ends the brush.');
        if (!isOpen || !info) return;
        brush.radius ||= Math.max(FIRST_RADIUS * diagonal(), voxel());
        radius.limits(Math.log2(voxel() / 2), Math.log2(most));
        colorRow.hidden = !info.hasColors || brush.verb === 'remove';
        if (info.materials && !materials) {
          const names = info.materials;
          materials = choice({
            label: 'Material', options: [['', 'As around it'], ...names.map((_, id) => /** @type {[string, string]} */ ([String(id), materialName(names, id)]))],
            get: () => String(brush.material ?? ''), set(id) { brush.material = id === '' ? null : Number(id); },
          });
          materialPart.replaceChildren(materials.element);
        }
        materialPart.hidden = brush.verb === 'remove';
        refreshAll([verbs, shapes, radius, file, ...(materials ? [materials] : [])])(settings);
        start.setAttribute('aria-pressed', String(tool.active));
        back.disabled = undos === 0;
        forth.disabled = redos === 0;
      },
    },
  };
}
