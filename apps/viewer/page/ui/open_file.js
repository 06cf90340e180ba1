/** Opens files that a person chooses, drops or pastes: scenes, pages with scenes, settings, camera paths, and models to build. */
import { chosenFiles, filesOf, unpacked } from '../build/gather_files.js';
import { kindOf, mainFile } from '../build/input_kinds.js';
import { hasProgram, run } from '../build/program.js';
import { SettingsError, mergeSettings, settingsFromJson } from '../settings.js';
import { button } from './controls.js';
import { h } from './dom.js';

/** @typedef {import('./interface.js').Ui} Ui */
/** @typedef {import('../build/input_kinds.js').NamedFile} NamedFile */

/** A file of settings is at most this long, in bytes. */
const LONGEST_SETTINGS = 16 << 20;

/** Opens one file, a model with its files, or a ZIP of them; or shows one line that says why not. @param {Ui} ui @param {NamedFile[]} given */
export async function openFiles(ui, given) {
  if (given.length === 0) return;
  const label = given.length === 1 ? given[0].name : given[0].name.split('/')[0];
  try {
    const files = await unpacked(given), found = mainFile(files), [first] = files;
    if (found === null) {
      const scene = files.find(({ name }) => /\.(vdag|html|json)$/i.test(name)) ?? (files.length === 1 ? first : null);
      if (scene === null) throw new Error('no file that the page opens is in it');
      return await openOne(ui, scene);
    }
    const { main, others } = found, kind = await kindOf(main);
    if (kind !== null) await ui.build(main, kind, files, others > 0 ? `The largest of ${others + 1}: ${main.name}` : '');
  } catch (error) {
    ui.toast(`${label}: ${error instanceof Error ? error.message : error}`, true);
  }
}

/** Opens a file that needs no building. @param {Ui} ui @param {NamedFile} file */
async function openOne(ui, { name, data }) {
  const start = await data.slice(0, 64).text();
  if (/^\uFEFF?\s*[[{]/.test(start) || /\.json$/i.test(name)) return openSettings(ui, name, data);
  const file = new File([data], name);
  try {
    await ui.viewer.open(file);
  } catch (error) {
    if (!/has the compact form/.test(/** @type {Error} */ (error).message) || !hasProgram()) throw error;
    if (!(await openCompact(ui, file))) return;
  }
  ui.toast(`Opened ${name}`);
}

/** Opens a scene in the compact form: the program decodes it. @param {Ui} ui @param {File} file */
const openCompact = (ui, file) => ui.job('Decode the scene', async ({ signal, progress }) => {
  const args = ['convert', '/in/compact.vdag', '--plain', '-o', `/out/${file.name.replace(/^.*\//, '')}`, '-q'];
  const { files } = await run(args, [{ name: 'compact.vdag', data: file }], { signal, onProgress: progress });
  await ui.viewer.open(files[0]);
});

/** Loads settings or a camera path. @param {Ui} ui @param {string} name @param {Blob} file */
async function openSettings(ui, name, file) {
  const { viewer } = ui;
  if (file.size > LONGEST_SETTINGS) throw new SettingsError('longer than 16 MiB');
  const text = await file.text();
  /** @type {string[]} */
  const ignored = [];
  let value = null;
  try { value = JSON.parse(text); } catch { /* settingsFromJson says why */ }
  if (Array.isArray(value?.keys) && !('version' in value)) {
    const sun = value.sun ? { sun: { direction: value.sun } } : {};
    viewer.set(mergeSettings(viewer.get(), { path: value.keys, ...sun }, ignored), 'file');
    ui.open('film');
    ui.toast(`Camera path with ${value.keys.length} keys`);
  } else {
    viewer.set(settingsFromJson(text, ignored), 'file');
    ui.toast('Settings loaded');
  }
  if (ignored.length) ui.toast(`${name}: loaded without the unknown keys ${ignored.join(', ')}`, true);
}

/** Passes on the files that are dropped on an element, or pasted. @param {HTMLElement} element @param {(files: NamedFile[]) => void} take @param {(error: Error) => void} fail */
export function acceptFiles(element, take, fail) {
  const pass = (/** @type {DataTransfer} */ transfer) => filesOf(transfer).then(take, fail);
  element.addEventListener('dragover', (event) => {
    if (![...(event.dataTransfer?.items ?? [])].some((item) => item.kind === 'file')) return;
    event.preventDefault();
    element.classList.add('dropping');
  });
  element.addEventListener('dragleave', (event) => {
    if (!element.contains(/** @type {Node | null} */ (event.relatedTarget))) element.classList.remove('dropping');
  });
  element.addEventListener('drop', (event) => {
    event.preventDefault();
    element.classList.remove('dropping');
    if (event.dataTransfer) pass(event.dataTransfer);
  });
  window.addEventListener('paste', (event) => {
    if (event.clipboardData?.files.length) pass(event.clipboardData);
  });
}

/**
 * Makes a button that lets a person choose files, or a folder.
 * @param {Ui} ui @param {string} label @param {{folder?: boolean, primary?: boolean}} [options]
 */
export function chooseButton(ui, label, { folder = false, primary } = {}) {
  const chooser = h('input', { type: 'file', multiple: !folder, webkitdirectory: folder, class: 'offscreen', tabindex: -1, 'aria-label': label, on: {
    change() {
      openFiles(ui, chosenFiles(/** @type {FileList} */ (chooser.files)));
      chooser.value = '';
    },
  } });
  return h('span', {}, button(label, () => chooser.click(), { primary }), chooser);
}
