/** The panel "Materials": the materials or labels of the file, how many cells each has, and which are hidden. */
import { button, group } from './controls.js';
import { h, resize, say } from './dom.js';
import { countText } from './numbers.js';

/** Materials that the list shows, at most: the largest ones. */
const MOST_LISTED = 500;

/** Returns the name of a material. @param {string[]} names @param {number} id */
export const materialName = (names, id) => names[id] || `Material ${id}`;

/** Returns the ids in the order of the list: the largest first. @param {number} count @param {number[] | null} cells */
export function listedIds(count, cells) {
  const ids = Array.from({ length: count }, (_, id) => id).filter((id) => !cells || cells[id] > 0);
  if (cells) ids.sort((a, b) => cells[b] - cells[a] || a - b);
  return ids.slice(0, MOST_LISTED);
}

/** Returns the hidden ids with one more, or without it. @param {readonly number[]} hidden @param {number} id @param {boolean} isShown */
export const withShown = (hidden, id, isShown) => (isShown ? hidden.filter((other) => other !== id) : [...new Set([...hidden, id])].sort((a, b) => a - b));

/** @param {import('./interface.js').Ui} ui */
export function materialsPanel(ui) {
  const { viewer } = ui;
  const names = () => viewer.info?.materials ?? [];
  const setShown = (/** @type {number} */ id, /** @type {boolean} */ isShown) => {
    viewer.set({ hidden: withShown(viewer.get().hidden, id, isShown) }, 'ui');
    ui.announce(`${materialName(names(), id)} ${isShown ? 'shown' : 'hidden'}`);
  };
  const tool = ui.tool({
    hint: () => 'Click what to hide · Escape ends',
    click(hit) {
      const id = viewer.material(hit);
      if (id === null) return ui.toast('The materials have not arrived yet');
      setShown(id, false);
      ui.toast(`${materialName(names(), id)} is hidden`);
    },
  });
  /** @type {number[]} */
  let ids = [];
  const list = h('ul', { class: 'list materials' }), note = h('p', { class: 'hint' });
  const newItem = (/** @type {number} */ i) => {
    const input = h('input', { type: 'checkbox', role: 'switch', on: { change: () => setShown(ids[i], input.checked) } });
    return h('li', {}, h('label', { class: 'row toggle' }, h('span', {}), h('output', {}), input));
  };
  const pick = button('Hide by clicking', () => tool.toggle(), { primary: true });
  const all = button('Show all', () => viewer.set({ hidden: [] }, 'ui'));
  return {
    element: h('div', {}, group('', h('div', { class: 'buttons' }, pick, all), note), list),
    refresh(/** @type {import('../settings.js').Settings} */ { hidden }) {
      const counts = viewer.materialCounts(), count = counts?.length ?? names().length;
      ids = listedIds(count, counts);
      const total = counts?.reduce((sum, x) => sum + x, 0) ?? 0;
      resize(list, ids.length, newItem);
      ids.forEach((id, i) => {
        const [name, cells, input] = /** @type {any} */ (list.children[i].firstChild).children;
        say(name, materialName(names(), id));
        say(cells, counts ? `${countText(counts[id])} · ${(100 * counts[id] / total).toPrecision(2)}%` : '');
        input.checked = !hidden.includes(id);
      });
      say(note, counts && ids.length === MOST_LISTED ? `The ${MOST_LISTED} largest of ${count}.` : 'Rays of view and light pass through what is hidden.');
      pick.setAttribute('aria-pressed', String(tool.active));
      all.disabled = hidden.length === 0;
    },
  };
}
