/** The panel "Save and share": the link, settings as a file, and pictures. */
import { hasProgram } from '../build/program.js';
import { settingsToJson } from '../settings.js';
import { button, choice, group, textField } from './controls.js';
import { copy, download, h } from './dom.js';
import { embedCode, whyNotShared, withoutSecret } from './link_reach.js';
import { chooseButton } from './open_file.js';
import { saveScene } from './save_scene.js';

/**
 * @typedef {import('./interface.js').Ui} Ui
 * @typedef {import('../settings.js').Settings} Settings
 */

/** Pixels of saved pictures. */
const SIZES = ['1280x720', '1920x1080', '2560x1440', '3840x2160'];
/** Links longer than this are cut by some programs. */
const LONG_LINK = 8000;

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
    const hash = ui.hash(), address = withoutSecret(location.href.split('#')[0]) + (hash ? '#' + hash : '');
    const why = viewer.file !== null ? 'the scene is a file on this computer' : whyNotShared(address);
    if (!(await copy(make(address)))) return ui.toast('The browser did not allow copying; the link is in the address bar', true);
    if (why) return ui.toast(`${what} copied, but others cannot open the link: ${why}`, true);
    ui.toast(address.length > LONG_LINK ? `${what} copied. It is long: save the settings as a file instead, if it arrives cut` : `${what} copied`);
  };
  const save = () => {
    const text = settingsToJson({ ...viewer.get(), camera: viewer.camera() });
    download(`${ui.name()}.settings.json`, new Blob([text], { type: 'application/json' }));
  };
  const title = textField({
    label: 'Title', most: 200, hint: 'Instead of the name of the scene', get: (s) => s.title, set: (value) => viewer.set({ title: value }, 'ui'),
  });
  const licence = textField({
    label: 'Licence', most: 500, hint: 'Shown below the title', get: (s) => s.licence, set: (value) => viewer.set({ licence: value }, 'ui'),
  });
  const picture = button('Save picture', screenshot, { icon: 'camera', primary: true, title: 'Key P', keys: 'P' });
  return {
    element: h('div', {},
      group('Link', h('div', { class: 'buttons' }, button('Copy link', () => share('Link', (address) => address), { icon: 'link' }),
        button('Copy embed code', () => share('Code', (address) => embedCode(address, viewer.info?.name || 'Scene')), {
          icon: 'copy', title: 'HTML that shows this page in another one',
        })), h('p', { class: 'hint' },
        'The address of this page always holds the view, the light, the section, measures and notes.'), title.element, licence.element),
      group('Picture', sizes.element, qualities.element, picture),
      saveScene(ui),
      group('Files', h('div', { class: 'buttons' }, chooseButton(ui, 'Open…'), button('Save settings', save)),
        h('p', { class: 'hint' }, 'Opens a scene (.vdag), a page with a scene (.html), settings or a camera path (.json)' + (hasProgram() ? ', or a model to build' : '') + '; or drop the file on the picture. It stays on this computer.'),
        h('p', { class: 'hint' }, 'With saved settings you can make a page that shows this view first, and a still in full quality:'),
        ui.command('voxdag export scene.vdag --view scene.settings.json --poster -o scene.html'),
        ui.command('voxdag render scene.vdag --view scene.settings.json -o still.png'))),
    refresh(/** @type {Settings} */ settings) {
      for (const field of [title, licence]) field.refresh(settings);
      sizes.refresh(settings);
      qualities.refresh(settings);
    },
    screenshot,
  };
}
