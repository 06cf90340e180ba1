/**
 * Controls of the panels. Each is { element, refresh }: `get` reads the settings, `set` changes
 * them, and `refresh` shows settings that have changed elsewhere.
 */
import { clamp } from '../math.js';
import { h, resize } from './dom.js';
import { icon } from './icons.js';

/**
 * @typedef {import('../settings.js').Settings} Settings
 * @typedef {{element: HTMLElement, refresh: (settings: Settings) => void}} Control
 */

/** The key at the end of a name, such as " (O)". */
const KEY = / \([^)]*\)$/;

let ids = 0;
const newId = () => `c${++ids}`;

/**
 * Returns the number that a person has typed, or null: `words` are texts with a meaning, such as "off".
 * @param {string} typed @param {Map<string, number>} words
 */
export function typedNumber(typed, words) {
  const word = words.get(typed.trim().toLowerCase());
  if (word !== undefined) return word;
  // A comma may be the decimal sign; units and the sign of multiplication are left out.
  const digits = /[-\u2212]?\s*(\d+(?:[.,]\d*)?|[.,]\d+)(e[-+]?\d+)?/i.exec(typed)?.[0];
  const value = digits === undefined ? NaN : Number(digits.replace('\u2212', '-').replace(',', '.').replace(/\s/g, ''));
  return Number.isFinite(value) ? value : null;
}

/**
 * Makes a slider of a number, and a field beside it in which one can type the number. `to` and `from` map the value to
 * the slider's position, from `min` to `max`. The field has `per` times the value; a `whole` value is rounded.
 * @param {{label: string, min: number, max: number, step?: number | 'any', get: (settings: Settings) => number,
 *   set: (value: number) => void, text?: (value: number) => string, to?: (value: number) => number,
 *   from?: (position: number) => number, hint?: string, per?: number, whole?: boolean}} options
 * @returns {Control & {limits: (min: number, max: number, step?: number | 'any') => void}}
 */
export function slider(options) {
  const { label, min, max, step = 'any', get, set, hint, per = 1, whole = false } = options;
  const { text = (x) => String(+x.toPrecision(4)), to = (x) => x, from = (x) => x } = options;
  const id = newId();
  let now = NaN;
  const changed = () => {
    const value = from(Number(input.value));
    show(value);
    set(value);
  };
  /** The ends of the slider, as values. */
  const ends = () => [Number(input.min), Number(input.max)].map(from);
  const typed = () => {
    const [low, high] = ends(), words = new Map([low, high].map((end) => [text(end).toLowerCase(), end * per]));
    const value = field.value === shown ? null : typedNumber(field.value, words);
    if (value === null) return show(now);
    const wanted = clamp(value / per, Math.min(low, high), Math.max(low, high));
    set(whole ? Math.round(wanted) : wanted);
    field.value = text(now);
  };
  /** The text of the field when it got the focus. */
  let shown = '';
  const input = h('input', { type: 'range', id, min, max, step, on: { input: changed } });
  const field = h('input', {
    type: 'text', class: 'number', inputmode: 'decimal', 'aria-label': `${label}, number`, autocomplete: 'off', on: {
      focus() {
        // The number in full; a word, such as "off", stays.
        if (typedNumber(text(now), new Map()) !== null) field.value = String(+(now * per).toPrecision(12));
        shown = field.value;
        field.select();
      },
      blur: typed,
      keydown: (event) => {
        if (event.key === 'Escape') {
          event.stopPropagation();
          field.value = shown;
        }
        if (event.key === 'Enter' || event.key === 'Escape') field.blur();
      },
    },
  });
  const show = (/** @type {number} */ value) => {
    now = value;
    if (document.activeElement !== field) field.value = text(value);
    input.setAttribute('aria-valuetext', text(value));
    const low = Number(input.min), high = Number(input.max);
    input.style.setProperty('--part', `${100 * clamp((to(value) - low) / (high - low || 1), 0, 1)}%`);
  };
  return {
    element: h('div', { class: 'row slider' }, h('label', { for: id, title: hint }, label), field, input),
    refresh(settings) {
      const value = get(settings), position = to(value);
      // Rounding must not move a slider that is being dragged.
      if (Math.abs(Number(input.value) - position) > 1e-6 * Math.abs(position)) input.value = String(position);
      show(value);
    },
    limits(low, high, by = 'any') {
      Object.assign(input, { min: String(low), max: String(high), step: String(by) });
    },
  };
}

/** Returns options of a slider whose position is a logarithm, with zero at its left end. @param {number} least */
export const logarithmic = (least) => ({
  to: (/** @type {number} */ x) => Math.log2(Math.max(x, least)),
  from: (/** @type {number} */ x) => (x <= Math.log2(least) ? 0 : +(2 ** x).toPrecision(3)),
});

/**
 * Makes a switch.
 * @param {{label: string, get: (settings: Settings) => boolean, set: (on: boolean) => void, hint?: string}} options
 * @returns {Control & {input: HTMLInputElement}}
 */
export function toggle({ label, get, set, hint }) {
  const input = h('input', { type: 'checkbox', role: 'switch', on: { change: () => set(input.checked) } });
  return {
    element: h('label', { class: 'row toggle', title: hint }, h('span', {}, label), input),
    refresh(settings) { input.checked = get(settings); },
    input,
  };
}

/**
 * Makes a list that opens, to choose one of several.
 * @template {string} T
 * @param {{label: string, options: [T, string][] | (() => [T, string][]), get: (settings: Settings) => T, set: (value: T) => void}} options
 * @returns {Control}
 */
export function choice({ label, options, get, set }) {
  const id = newId();
  const select = h('select', { id, on: { change: () => set(/** @type {T} */ (select.value)) } });
  const fill = (/** @type {[T, string][]} */ all) => {
    resize(select, all.length, () => h('option'));
    all.forEach(([value, name], i) => Object.assign(select.options[i], { value, text: name }));
  };
  if (typeof options !== 'function') fill(options);
  return {
    element: h('div', { class: 'row choice' }, h('label', { for: id }, label), select),
    refresh(settings) {
      if (typeof options === 'function') fill(options());
      select.value = get(settings);
    },
  };
}

/**
 * Makes radio buttons side by side, to choose one of a few.
 * @template {string} T
 * @param {{label: string, options: [T, string, string?][], get: (settings: Settings) => T, set: (value: T) => void,
 *   bare?: boolean}} options  Values, names and icons; `bare`: icons, and names on wide screens.
 * @returns {Control}
 */
export function segments({ label, options, get, set, bare }) {
  const name = newId();
  const inputs = options.map(([value, text]) =>
    h('input', { type: 'radio', name, value, 'aria-label': bare ? text : null, class: 'offscreen', on: { change: () => set(value) } }));
  return {
    element: h('div', { class: 'segments', role: 'radiogroup', 'aria-label': label },
      ...options.map(([, text, image], i) =>
        h('label', { title: bare ? text : null }, inputs[i], image && icon(image), h('span', { class: bare ? 'wide-label' : null }, text.replace(KEY, ''))))),
    refresh(settings) {
      const value = get(settings);
      for (const input of inputs) input.checked = input.value === value;
    },
  };
}

/**
 * Makes a line of text.
 * @param {{label: string, most: number, hint?: string, get: (settings: Settings) => string, set: (value: string) => void, event?: string}} options  `most`: characters;
 *   `event`: "change" waits for the end of typing.
 * @returns {Control}
 */
export function textField({ label, most, hint, get, set, event = 'input' }) {
  const id = newId(), waits = event === 'change', changed = () => {
    if (waits) input.blur();
    set(input.value);
  };
  const input = h('input', { type: 'text', id, maxlength: most, on: { [event]: changed } });
  return {
    element: h('div', { class: 'row text' }, h('label', { for: id, title: hint }, label), input),
    refresh(settings) {
      // Text that is being typed stays.
      if (input.value !== get(settings) && !(waits && document.activeElement === input)) input.value = get(settings);
    },
  };
}

/**
 * Makes a button.
 * @param {string} label @param {() => void} act
 * @param {{icon?: string, bare?: boolean, wide?: boolean, primary?: boolean, title?: string, keys?: string}} [options]  `bare`: an icon; `wide`: and the label on wide screens.
 */
export function button(label, act, { icon: image, bare, wide, primary, title, keys } = {}) {
  return h('button', {
    type: 'button', class: primary ? 'primary' : bare ? 'bare' : null, title: title ?? (bare ? label : null),
    'aria-label': bare ? label : null, 'aria-keyshortcuts': keys, on: { click: act },
  }, image && icon(image), !bare && label, wide && h('span', { class: 'wide-label' }, label.replace(KEY, '')));
}

/** Makes a part of a panel; a title may be empty. @param {string} title @param {...import('./dom.js').Child} children */
export const group = (title, ...children) =>
  h('section', { class: 'group' }, title && h('h3', {}, title), ...children);

/** Returns a function that refreshes several controls. @param {Control[]} controls */
export const refreshAll = (controls) => (/** @type {Settings} */ settings) => {
  for (const control of controls) control.refresh(settings);
};
