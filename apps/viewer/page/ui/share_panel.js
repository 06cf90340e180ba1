/** The panel "Save and share": the link, settings as a file, and pictures. */
import { SettingsError, mergeSettings, settingsFromJson, settingsToJson } from '../settings.js';
import { button, choice, group } from './controls.js';
import { copy, download, h } from './dom.js';
import { embedCode, whyNotShared } from './link_reach.js';

/**
 * @typedef {import('./interface.js').Ui} Ui
 * @typedef {import('../settings.js').Settings} Settings
 */

/** Pixels of saved pictures. */
const SIZES = ['1280x720', '1920x1080', '2560x1440', '3840x2160'];
/** Links longer than this are cut by some programs. */
const LONG_LINK = 8000;
/** A file of settings is at most this long, in bytes. */
const LONGEST_FILE = 16 << 20;

/** @param {Ui} ui */
export function sharePanel(ui) {
  const { viewer } = ui;
  let size = 'window', samples = '16';
  const sizes = choice({
    label: 'Size',
    options: [['window', 'as shown'], ...SIZES.map((name) => /** @type {[string, string]} */ ([name, name.replace('x', ' × ')]))],
    get: () => size, set: (value) => { size = value; },
  });
  const qualities = choice({
    label: 'Quality', options: [['4', '4 samples'], ['16', '16 samples'], ['64', '64 samples']],
    get: () => samples, set: (value) => { samples = value; },
  });
  const screenshot = async () => {
    const [width, height] = size === 'window' ? [undefined, undefined] : size.split('x').map(Number);
    picture.disabled = true;
    const done = await ui.job('Picture', async (job) =>
      download(`${ui.name()}.png`, await viewer.capture({ width, height, samples: Number(samples), ...job })));
    if (done) ui.toast('Saved as PNG');
    picture.disabled = false;
  };
  /** Copies a text that is made of the page's address. @param {string} what @param {(address: string) => string} make */
  const share = async (what, make) => {
    const hash = ui.hash(), address = location.href.split('#')[0] + (hash ? '#' + hash : ''), why = whyNotShared(address);
    if (!(await copy(make(address)))) return ui.toast('The browser did not allow copying; the link is in the address bar', true);
    if (why) return ui.toast(`${what} copied, but others cannot open the link: ${why}`, true);
    ui.toast(address.length > LONG_LINK ? `${what} copied. It is long: save the settings as a file instead, if it arrives cut` : `${what} copied`);
  };
  const save = () => {
    const text = settingsToJson({ ...viewer.get(), camera: viewer.camera() });
    download(`${ui.name()}.settings.json`, new Blob([text], { type: 'application/json' }));
  };
  /** Loads settings or a camera path. @param {File} file */
  const load = async (file) => {
    try {
      if (file.size > LONGEST_FILE) throw new SettingsError('longer than 16 MiB');
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
      if (ignored.length) console.warn(`${file.name}: unknown keys: ${ignored.join(', ')}`);
    } catch (error) {
      if (!(error instanceof SettingsError)) throw error;
      ui.toast(`${file.name}: ${error.message}`, true);
    }
  };
  const chosen = () => {
    if (chooser.files?.[0]) load(chooser.files[0]);
    chooser.value = '';
  };
  const chooser = h('input', {
    type: 'file', accept: '.json,application/json', class: 'offscreen', tabindex: -1, 'aria-label': 'File of settings',
    on: { change: chosen },
  });
  const picture = button('Save picture', screenshot, { icon: 'camera', primary: true, title: 'Key P', keys: 'P' });
  return {
    element: h('div', {},
      group('Link', h('div', { class: 'buttons' }, button('Copy link', () => share('Link', (address) => address), { icon: 'link' }),
        button('Copy embed code', () => share('Code', (address) => embedCode(address, viewer.info?.name || 'Scene')), {
          icon: 'copy', title: 'HTML that shows this page in another one',
        })), h('p', { class: 'hint' },
        'The address of this page always holds the view, the light, the section, measures and notes.')),
      group('Picture', sizes.element, qualities.element, picture),
      group('Settings', h('div', { class: 'buttons' }, button('Save', save), button('Load…', () => chooser.click())), chooser,
        h('p', { class: 'hint' }, 'Or drop a file on the picture. A still in full quality from saved settings:'),
        ui.command('voxdag render scene.vdag --view scene.settings.json -o still.png'))),
    refresh(/** @type {Settings} */ settings) {
      sizes.refresh(settings);
      qualities.refresh(settings);
    },
    screenshot,
    load,
  };
}
