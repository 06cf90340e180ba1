/** Shows the progress of loading, short messages and failures. */
import { button } from './controls.js';
import { h, say } from './dom.js';
import { icon } from './icons.js';
import { legend } from './legend.js';
import { bytesText, countText } from './numbers.js';

/** @typedef {import('../viewer_types.js').Viewer} Viewer */

const TOAST_MS = 2600, ERROR_MS = 9000;

/**
 * Makes a card that says what failed and what to do.
 * @param {string} title @param {string} text @param {HTMLElement[]} [actions]
 */
export const failureCard = (title, text, actions = []) =>
  h('div', { class: 'failure', role: 'alert' }, icon('warning'), h('h2', {}, title), h('p', {}, text),
    actions.length > 0 && h('div', { class: 'buttons' }, ...actions));

/** Makes a button that loads the page again. */
export const tryAgain = () => button('Try again', () => location.reload(), { primary: true });

export class Status {
  /** @param {Viewer} viewer @param {HTMLElement} container */
  constructor(viewer, container) {
    this.viewer = viewer;
    this.container = container;
    this.name = h('h1', {});
    this.detail = h('p', {});
    this.licence = h('p', { class: 'licence', hidden: true });
    const range = { 'aria-valuemin': 0, 'aria-valuemax': 100 };
    this.bar = h('div', { class: 'progress', role: 'progressbar', 'aria-label': 'Loading', ...range }, h('i', {}));
    this.message = h('div', { class: 'toast', hidden: true });
    this.pill = h('div', { class: 'toast tool-hint', hidden: true });
    this.live = h('div', { class: 'offscreen', role: 'status', 'aria-live': 'polite' });
    container.append(this.bar, h('header', { class: 'title' }, this.name, this.detail, this.licence, legend(viewer)), this.pill, this.message, this.live);
    this.timer = 0;
    /** @type {HTMLElement | null} */
    this.failure = null;
    viewer.on('info', () => this.#loading());
    viewer.on('settings', (_, by) => { if (by !== 'hands' && by !== 'film') this.#name(); });
    viewer.on('progress', ({ channel, bytes, total }) => (channel ? this.#part(Math.min(1, bytes / total)) : this.#loading()));
    for (const event of ['level', 'still']) viewer.on(event, () => this.#loading());
    viewer.on('loaded', () => { this.isLoaded = true; this.#loading(); });
    viewer.on('opened', () => { this.isLoaded = false; this.#mend(); });
    viewer.on('note', (text) => this.toast(text, true));
    viewer.on('error', (error) => this.fail(error));
    viewer.on('lost', () => this.fail({
      title: 'The graphics were interrupted', isLost: true,
      text: 'The browser has taken the graphics away, perhaps because memory was short. The picture comes back when they do.',
    }));
    viewer.on('restored', () => { if (this.lost) this.#mend(); });
    this.lost = false;
    // A canvas without a picture is black.
    container.classList.add('waiting');
    const first = () => {
      viewer.off('frame', first);
      container.classList.remove('waiting');
      container.querySelector('.poster')?.remove();
    };
    viewer.on('frame', first);
    this.#loading();
  }
  isLoaded = false;

  #loading() {
    const { info } = this.viewer;
    if (!info) {
      say(this.detail, 'Opening the scene…');
      return;
    }
    document.getElementById('start')?.remove();
    const s = this.viewer.statistics(), total = s.fileBytes || info.fileBytes;
    const done = this.isLoaded || (s.levelsLoaded >= info.levels && s.bytesLoaded >= total);
    this.#name();
    say(this.detail, done ? `${countText(info.resolution)}³ · ${countText(info.voxels)} voxels`
      : `Level ${s.levelsLoaded} of ${info.levels} · ${bytesText(s.bytesLoaded)} of ${bytesText(total)}`);
    this.#part(done ? 1 : total > 0 ? Math.min(1, s.bytesLoaded / total) : 0, done);
  }

  /** Shows which part has arrived. @param {number} part  0 to 1. @param {boolean} [done] */
  #part(part, done = part === 1) {
    this.bar.setAttribute('aria-valuenow', String(Math.round(100 * part)));
    /** @type {HTMLElement} */ (this.bar.firstChild).style.transform = `scaleX(${part})`;
    this.bar.classList.toggle('done', done);
    this.bar.setAttribute('aria-hidden', String(done));
  }

  /** Shows the title and the licence. */
  #name() {
    const { title, licence } = this.viewer.get(), name = title || this.viewer.info?.name || 'Scene';
    say(this.name, name);
    document.title = title || `${name} – voxdag`;
    say(this.licence, licence);
    this.licence.hidden = licence === '';
  }

  /** Shows a short message. @param {string} text @param {boolean} [isError] @param {boolean} [stays]  Until the next message. */
  toast(text, isError = false, stays = false) {
    say(this.message, text);
    this.announce(text);
    this.message.classList.toggle('error', isError);
    this.message.hidden = false;
    clearTimeout(this.timer);
    if (stays) return;
    this.timer = setTimeout(() => { this.message.hidden = true; }, isError ? ERROR_MS : TOAST_MS);
  }

  /** Keeps a hint while a tool is in use; an empty text ends it. @param {string} text */
  hint(text) {
    if (text && text !== this.pill.textContent) this.announce(text);
    say(this.pill, text);
    this.pill.hidden = text === '';
  }

  /** Tells screen readers a text. @param {string} text */
  announce(text) {
    this.live.textContent = '';
    this.live.textContent = text;
  }

  /** Shows a failure. @param {{title: string, text: string, isLost?: boolean}} error */
  fail({ title, text, isLost = false }) {
    document.getElementById('start')?.remove();
    this.#mend();
    this.lost = isLost;
    const shows = !isLost && this.viewer.info !== null && this.viewer.statistics().levelsLoaded > 0;
    const goOn = button('Go on with what is here', () => this.#mend());
    this.failure = failureCard(title, text, isLost ? [] : shows ? [tryAgain(), goOn] : [tryAgain()]);
    // A picture that has been drawn stays in sight.
    this.failure.classList.toggle('aside', shows);
    this.container.append(this.failure);
    this.container.classList.toggle('failed', !shows);
  }

  #mend() {
    this.failure?.remove();
    this.failure = null;
    this.lost = false;
    this.container.classList.remove('failed');
  }
}
