/** Opens files that a person chooses or drops on the page: scenes, pages with scenes, settings, camera paths. */
import { SettingsError, mergeSettings, settingsFromJson } from '../settings.js';

/** @typedef {import('./interface.js').Ui} Ui */

/** A file of settings is at most this long, in bytes. */
const LONGEST_SETTINGS = 16 << 20;

/** Opens a file, or shows one line that says why not. @param {Ui} ui @param {File} file */
export async function openFile(ui, file) {
  const { viewer } = ui;
  try {
    const start = await file.slice(0, 64).text();
    if (/^\uFEFF?\s*[[{]/.test(start) || /\.json$/i.test(file.name)) return await openSettings(ui, file);
    await viewer.open(file);
    ui.toast(`Opened ${file.name}`);
  } catch (error) {
    ui.toast(`${file.name}: ${error instanceof Error ? error.message : error}`, true);
  }
}

/** Loads settings or a camera path. @param {Ui} ui @param {File} file */
async function openSettings(ui, file) {
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
  if (ignored.length) ui.toast(`${file.name}: loaded without the unknown keys ${ignored.join(', ')}`, true);
}

/** Passes on the first of the files that are dropped on an element. @param {HTMLElement} element @param {(file: File) => void} take */
export function acceptFiles(element, take) {
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
    const file = event.dataTransfer?.files[0];
    if (file) take(file);
  });
}
