/** Keeps the address of the page in step with the settings. */
import { settingsFromHash } from '../settings_link.js';

/** @typedef {import('./interface.js').Ui} Ui */

/** Milliseconds without a change before the address follows: browsers limit such changes. */
const PAUSE_MS = 400;

/** Writes changes into the address, and reads links that are pasted there. @param {Ui} ui @param {import('../settings.js').Settings} base  What a link without keys shows. */
export function keepLink(ui, base) {
  const { viewer } = ui;
  let timer = 0, written = location.hash.replace(/^#/, '');
  const write = () => {
    if (ui.hands.moved) return later();  // the camera still moves: frames are slow
    if (viewer.file !== null) return;  // the address leads to another scene
    const hash = ui.hash();
    if (hash === written) return;
    written = hash;
    try {
      history.replaceState(history.state, '', location.pathname + location.search + (hash ? '#' + hash : ''));
    } catch {
      // Pages without an address, as in a frame of a document, cannot have one.
    }
  };
  const later = () => {
    clearTimeout(timer);
    if (viewer.info) timer = setTimeout(write, PAUSE_MS);
  };
  viewer.on('settings', later);
  window.addEventListener('hashchange', () => {
    const hash = location.hash.replace(/^#/, '');
    if (hash === written) return;
    written = hash;
    const { settings, problems } = settingsFromHash(hash, base);
    viewer.set(settings, 'link');
    if (problems.length) ui.toast(capitalized(problems[0]), true);
  });
}

/** Returns a text with a capital letter first. @param {string} text */
export const capitalized = (text) => text.charAt(0).toUpperCase() + text.slice(1);
