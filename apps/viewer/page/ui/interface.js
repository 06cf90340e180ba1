/** The interface around the picture: toolbar, panels, tools, read-out, shortcuts, messages. */
import { DEFAULTS } from '../settings.js';
import { settingsToHash } from '../settings_link.js';
import { isTyping, movingKey } from '../hands/keys.js';
import { buildPanel } from './build_panel.js';
import { comparePanel } from './compare_panel.js';
import { button, segments } from './controls.js';
import { copy, h } from './dom.js';
import { acceptFiles, openFiles } from './open_file.js';
import { filmPanel } from './film_panel.js';
import { helpPanel } from './help_panel.js';
import { icon } from './icons.js';
import { makeJobs } from './job.js';
import { lightPanel } from './light_panel.js';
import { nameOnLongPress } from './long_press.js';
import { materialsPanel } from './materials_panel.js';
import { measurePanel } from './measure_panel.js';
import { notesPanel } from './notes_panel.js';
import { Overlay } from './overlay.js';
import { Readout } from './readout.js';
import { scaleBar } from './scale_bar.js';
import { sectionPanel } from './section_panel.js';
import { sharePanel } from './share_panel.js';
import { statisticsPanel } from './statistics_panel.js';
import { Status } from './status.js';
import { SIDES, viewPanel } from './view_panel.js';

/**
 * @typedef {import('../viewer_types.js').Viewer} Viewer
 * @typedef {import('../viewer_types.js').Hit} Hit
 * @typedef {import('../settings.js').Settings} Settings
 * @typedef {import('../settings.js').Camera} Camera
 * @typedef {import('../hands/hands.js').Hands} Hands
 *
 * @typedef {object} Panel
 * @property {HTMLElement} element
 * @property {(settings: Settings) => void} refresh
 * @property {boolean} [everyFrame]  Refresh it when a frame was drawn.
 * @property {boolean} [followsCamera]  Refresh it when the camera has moved.
 *
 * @typedef {object} Tool  The use of a click on the picture.
 * @property {() => string} hint
 * @property {(hit: Hit) => void} click
 * @property {(hit: Hit | null, x: number, y: number) => void} [hover]
 * @property {(x: number, y: number) => import('../hands/pointers.js').Drag | null} [drag]  Takes drags from the camera; then there are no clicks.
 * @property {() => boolean} [finish]  Enter ends a part of its work; returns whether there was one.
 * @property {() => void} [end]
 *
 * @typedef {object} Extra  A panel that only some pages have.
 * @property {Panel} panel
 * @property {[string, [string, string][]]} help  Its keys: the title, and keys with what they do.
 * @property {() => void} act  What its key does.
 * @property {() => Promise<Blob | null>} scene  The file of the scene with its edits; null: it has none.
 *
 * @typedef {object} Ui  Parts of the interface that panels may use.
 * @property {Viewer} viewer
 * @property {Hands} hands
 * @property {Overlay} overlay
 * @property {(text: string, isError?: boolean, stays?: boolean) => void} toast
 * @property {ReturnType<typeof makeJobs>} job  Runs long work, with its progress and a button that cancels it.
 * @property {(text: string) => void} announce  For screen readers only.
 * @property {(name: string) => void} open
 * @property {(main: import('../build/input_kinds.js').NamedFile, kind: import('../build/input_kinds.js').Kind,
 *   files: import('../build/input_kinds.js').NamedFile[], note: string) => Promise<void>} build  Builds a scene of a model, which may use other files; then shows a note.
 * @property {() => Viewer | null} second  The viewer of the second scene, if there is one.
 * @property {() => void} refresh
 * @property {() => void} reset
 * @property {() => Camera} home
 * @property {() => Promise<Blob>} scene  The file of the scene, with edits.
 * @property {() => string} name  Of the scene, for files.
 * @property {() => string} hash
 * @property {(line: string) => HTMLElement} command  A line for a terminal, to copy.
 * @property {(tool: Tool) => {readonly active: boolean, toggle: () => void, stop: () => void}} tool
 */

/** @type {[string, string, string?][]} */
const ALL_PANELS = [
  ['edit', 'Edit', 'T'],
  ['build', 'Build'], ['view', 'View'], ['light', 'Light'], ['section', 'Section', 'B'], ['materials', 'Materials'], ['measure', 'Measure', 'M'], ['notes', 'Notes', 'N'],
  ['film', 'Camera path', 'K'], ['compare', 'Compare'], ['share', 'Save and share'], ['statistics', 'Statistics', 'I'], ['help', 'Help', 'H'],
];

/** Milliseconds between refreshes of numbers that change with every frame. */
const NUMBERS_MS = 250;

/**
 * Adds the interface to a container, in which an element holds only the viewer's canvas.
 * @param {Viewer} viewer @param {Hands} hands @param {HTMLElement} container @param {Settings} [base]  What the page begins with.
 * @param {((ui: Ui) => Extra) | null} [editing]  Makes the panel "Edit". @returns {Ui}
 */
export function createInterface(viewer, hands, container, base = DEFAULTS, editing = null) {
  const PANELS = editing ? ALL_PANELS : ALL_PANELS.slice(1);
  const status = new Status(viewer, container);
  const { canvas } = viewer;
  const overlay = new Overlay(viewer, canvas.parentElement ?? container);
  canvas.tabIndex = 0;
  canvas.setAttribute('role', 'application');
  canvas.setAttribute('aria-label', 'Picture of the scene. Arrow keys turn, W A S D move, H lists all keys.');
  /** @type {Tool | null} */
  let tool = null;
  let opened = '';

  const endTool = () => {
    const ended = tool;
    tool = null;
    ended?.end?.();
    showTool();
  };
  const showTool = () => {
    canvas.classList.toggle('picking', tool !== null);
    status.hint(tool ? tool.hint() : '');
    refresh();
  };

  /** @type {Ui} */
  const ui = {
    viewer, hands, overlay,
    toast: (text, isError, stays) => status.toast(text, isError, stays),
    job: makeJobs(container, (text, isError) => status.toast(text, isError)),
    announce: (text) => status.announce(text),
    open: (name) => { if (opened !== name) toggle(name); },
    build: (...model) => build.take(...model),
    second: () => compare.second(),
    refresh: () => refresh(),
    reset() {
      endTool();
      const { annotations, measures, path, title, licence } = viewer.get();
      viewer.set({ ...structuredClone(DEFAULTS), annotations, measures, path, title, licence }, 'ui');
      ui.toast('Settings reset; measures, notes and the camera path stay');
    },
    home: () => viewer.info?.view ?? viewer.camera(),
    scene: async () => (await edit?.scene()) ?? viewer.scene(),
    name: () => (viewer.info?.name ?? 'scene').replace(/^.*\//, '').replace(/\.\w+$/, '').replace(/[^\w.-]+/g, '_') || 'scene',
    command(line) {
      const act = async () => ui.toast((await copy(line)) ? 'Command copied' : 'The browser did not allow copying');
      return h('div', { class: 'command' }, h('code', { tabindex: 0 }, line),
        button('Copy this command', act, { icon: 'copy', bare: true }));
    },
    hash: () => settingsToHash(viewer.get(), viewer.info?.view ?? null, base),
    tool: (made) => ({
      get active() { return tool === made; },
      toggle() {
        if (tool === made) return endTool();
        endTool();
        tool = made;
        showTool();
      },
      stop() { if (tool === made) endTool(); },
    }),
  };

  const edit = editing?.(ui);
  const build = buildPanel(ui), section = sectionPanel(ui), measure = measurePanel(ui), notes = notesPanel(ui), film = filmPanel(ui), share = sharePanel(ui), compare = comparePanel(ui);
  /** @type {{[name: string]: Panel}} */
  const panels = {
    build, view: viewPanel(ui), light: lightPanel(ui), section, measure, notes, film, compare, materials: materialsPanel(ui), share, statistics: statisticsPanel(ui), help: helpPanel(edit && [edit.help]),
    ...(edit && { edit: edit.panel }),
  };
  const readout = new Readout(ui, container);
  scaleBar(ui, canvas.parentElement ?? container, () => opened === 'measure' || viewer.get().measures.length > 0);

  // Toolbar and panel.
  const title = h('h2', { id: 'panel-title' });
  const body = h('div', { class: 'panel-body' });
  const panel = h('aside', { class: 'panel', id: 'panel', hidden: true, 'aria-labelledby': 'panel-title' },
    h('header', {}, title, button('Close', () => toggle(opened), { icon: 'close', bare: true })), body);
  /** @type {Map<string, HTMLButtonElement>} */
  const openers = new Map();
  const toolbar = h('nav', { class: 'toolbar', 'aria-label': 'Panels' }, ...PANELS.map(([name, label, key]) => {
    const opener = h('button', {
      type: 'button', title: key ? `${label} (${key})` : label, 'aria-label': label, 'aria-expanded': 'false', 'aria-controls': 'panel',
      on: { click: () => toggle(name) },
    }, icon(name), h('span', { class: 'wide-label' }, label));
    openers.set(name, opener);
    return opener;
  }));

  /** Opens a panel, or closes it. @param {string} name */
  function toggle(name) {
    opened = opened === name ? '' : name;
    for (const [other, opener] of openers) opener.setAttribute('aria-expanded', String(other === opened));
    panel.hidden = opened === '';
    container.classList.toggle('has-panel', opened !== '');
    overlay.redraw();
    if (opened === '') return body.replaceChildren();
    title.textContent = PANELS.find(([other]) => other === opened)?.[1] ?? '';
    body.replaceChildren(panels[opened].element);
    body.scrollTop = 0;
    refresh();
  }

  const modes = segments({
    label: 'Move', bare: true, options: [['orbit', 'Orbit (O)', 'orbit'], ['fly', 'Fly (V)', 'fly'], ['walk', 'Walk (G)', 'walk']],
    get: (s) => s.mode, set: (mode) => viewer.set({ mode }, 'ui'),
  });
  const bar = h('div', { class: 'modes' }, modes.element,
    button('Home (R)', () => home(), { icon: 'home', bare: true, wide: true }),
    button('Frame (F)', () => hands.frame(), { icon: 'frame', bare: true, wide: true }));
  container.append(bar, toolbar, panel);
  nameOnLongPress(container, (name) => ui.toast(name));

  const home = () => {
    if (viewer.get().mode !== 'orbit') viewer.set({ mode: 'orbit' }, 'ui');
    hands.view('home');
  };
  function refresh() {
    const settings = viewer.get();
    showOpeners();
    modes.refresh(settings);
    if (opened) panels[opened].refresh(settings);
  }

  // Clicks on the picture.
  const use = async (/** @type {number} */ x, /** @type {number} */ y) => {
    const mine = tool, hit = await viewer.pick(x, y);
    if (!mine || tool !== mine) return;
    if (!hit) return ui.toast('There is no surface at this place');
    mine.click(hit);
    if (tool === mine) showTool();
  };
  hands.on('click', (x, y) => { if (tool) use(x, y); else readout.look(x, y, true); });
  hands.takesDoubleClick = (x, y) => {
    if (tool) use(x, y);
    return tool !== null;
  };
  hands.takesDrag = (x, y) => tool?.drag?.(x, y) ?? null;
  hands.on('hover', (x, y, down) => {
    if (!down) readout.look(x, y);
  });
  hands.on('speed', (factor) => status.toast(`Speed × ${+factor.toPrecision(2)}`));
  hands.on('leave', () => readout.clear());
  hands.on('gesture', () => readout.clear());
  readout.onHit = (hit, x, y) => tool?.hover?.(hit, x, y);

  // Keys.
  /** @type {{[key: string]: () => void}} */
  const shortcuts = {
    f: () => hands.frame(), r: home, h: () => toggle('help'), '?': () => toggle('help'), i: () => toggle('statistics'),
    c: () => readout.copy(), k: () => film.record(), p: () => share.screenshot(), l: () => hands.lockPointer(),
    b: () => { section.toggle(); ui.open('section'); },
    m: () => { ui.open('measure'); measure.tool.toggle(); }, n: () => { ui.open('notes'); notes.tool.toggle(); },
    ...(edit && { t: () => { ui.open('edit'); edit.act(); } }),
    o: () => viewer.set({ mode: 'orbit' }, 'ui'), v: () => viewer.set({ mode: 'fly' }, 'ui'), g: () => viewer.set({ mode: 'walk' }, 'ui'),
  };
  SIDES.forEach(([name], i) => { shortcuts[String(i + 1)] = () => hands.view(name); });
  const onKey = (/** @type {KeyboardEvent} */ event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || event.repeat || event.defaultPrevented) return;
    if (event.key === 'Escape') {
      const typing = document.activeElement instanceof HTMLElement && panel.contains(document.activeElement);
      if (tool) endTool();
      else if (opened) {
        const opener = openers.get(opened);
        toggle(opened);
        if (typing) opener?.focus();
      }
      return;
    }
    if (event.key === 'Enter' && tool?.finish && !isTyping(event) && tool.finish()) return showTool();
    // Digits by their place: some keyboards want Shift for them.
    const key = /^(?:Digit|Numpad)([1-9])$/.exec(event.code)?.[1] ?? event.key.toLowerCase();
    const act = shortcuts[key];
    if (!act || isTyping(event) || movingKey(event)) return;
    event.preventDefault();
    act();
  };
  window.addEventListener('keydown', onKey);

  acceptFiles(container, (files) => openFiles(ui, files), (error) => ui.toast(error.message, true));

  // Events of the viewer.
  viewer.on('settings', (settings, by) => {
    overlay.redraw();
    if (by !== 'hands' && by !== 'film') refresh();
    else if (opened && panels[opened].followsCamera) panels[opened].refresh(settings);
  });
  const showOpeners = () => {
    openers.get('materials')?.toggleAttribute('hidden', !viewer.info?.materials);
    openers.get('build')?.toggleAttribute('hidden', !build.hasModel());
  };
  for (const event of ['look', 'channel']) viewer.on(event, () => refresh());
  viewer.on('info', () => {
    overlay.redraw();
    refresh();
  });
  let numbersAt = 0;
  viewer.on('frame', () => {
    const now = performance.now();
    if (!opened || !panels[opened].everyFrame || now - numbersAt < NUMBERS_MS) return;
    numbersAt = now;
    panels[opened].refresh(viewer.get());
  });
  for (const event of ['level', 'still']) viewer.on(event, () => { if (opened && panels[opened].everyFrame) refresh(); });
  hands.on('rest', () => { if (opened === 'view') refresh(); });
  refresh();
  overlay.redraw();
  return ui;
}
