/** The panel "Measure": distances between points that one picks, drawn in the picture. */
import { distance, roundTo3, stepBelow } from '../math.js';
import { button, group } from './controls.js';
import { h, say, svg, update } from './dom.js';
import { lengthText } from './numbers.js';
import { pathOf, place, show } from './overlay.js';

/**
 * @typedef {import('./interface.js').Ui} Ui
 * @typedef {import('../math.js').Vec3} Vec3
 * @typedef {import('../settings.js').Settings} Settings
 * @typedef {import('../settings.js').Measure} Measure
 */

/** Returns the lengths along x, y and z. @param {Measure} measure */
const componentsOf = ({ from, to }) => to.map((x, i) => Math.abs(x - from[i]));

/** Makes the drawing of a measure: its line, ends, components and label. */
function drawnMeasure() {
  const line = svg('path', { class: 'measure-line' }), halo = svg('path', { class: 'halo' });
  const steps = ['x', 'y', 'z'].map((axis) => svg('path', { class: `measure-step axis-${axis}` }));
  const ends = [0, 1].map(() => svg('circle', { class: 'measure-end', r: 4 }));
  const label = svg('text', { class: 'label', 'text-anchor': 'middle', dy: -8 });
  return { element: svg('g', { class: 'measure' }, ...steps, halo, line, ...ends, label), line, halo, steps, ends, label };
}

/** @param {Ui} ui */
export function measurePanel(ui) {
  const { viewer, overlay } = ui;
  const voxel = () => viewer.info?.voxelSize ?? 1;
  const text = (/** @type {number} */ x) => lengthText(x, voxel() * 0.1);
  const rounded = (/** @type {Vec3} */ point) => roundTo3(point, stepBelow(voxel(), 0.001));
  /** The first point, while the second one is wanted, and where the pointer is. @type {{from: Vec3, to: Vec3} | null} */
  let open = null;
  /** The measure whose components are drawn. */
  let chosen = 0;
  /** @type {ReturnType<typeof drawnMeasure>[]} */
  const drawn = [];
  const layer = svg('g', {});

  overlay.add((projection, { measures }) => {
    const all = open ? [...measures, open] : measures;
    while (drawn.length < all.length) layer.append(drawn[drawn.push(drawnMeasure()) - 1].element);
    drawn.forEach((shape, i) => {
      const measure = all[i];
      show(shape.element, measure !== undefined);
      if (!measure) return;
      const { from, to } = measure, path = pathOf(projection.clipped([from, to], false));
      update(shape.line, { d: path });
      update(shape.halo, { d: path });
      /** @type {Vec3[]} */
      const corners = [from, [to[0], from[1], from[2]], [to[0], to[1], from[2]], to];
      const isChosen = i === chosen || measure === open;
      shape.steps.forEach((step, axis) =>
        update(step, { d: isChosen ? pathOf(projection.clipped(corners.slice(axis, axis + 2), false)) : '' }));
      const [a, b] = [from, to].map((point) => projection.at(point));
      place(shape.ends[0], a);
      place(shape.ends[1], b);
      place(shape.label, a && b && { x: (a.x + b.x) / 2, y: (a.y + b.y) / 2 });
      say(shape.label, text(distance(from, to)));
      show(shape.label, a !== null && b !== null && !(measure === open && from === to));
    });
  }, layer);

  const tool = ui.tool({
    hint: () => (open ? 'Click the second point' : 'Click the first point'),
    click(hit) {
      const point = rounded(hit.position);
      if (!open) open = { from: point, to: point };
      else {
        const { measures } = viewer.get(), done = { from: open.from, to: point };
        open = null;
        chosen = measures.length;
        viewer.set({ measures: [...measures, done] }, 'ui');
        ui.announce(`Distance ${text(distance(done.from, done.to))}`);
      }
      overlay.redraw();
    },
    hover(hit) {
      if (!open || !hit) return;
      open.to = hit.position;
      overlay.redraw();
    },
    end() {
      open = null;
      overlay.redraw();
    },
  });

  const start = button('Measure a distance', () => tool.toggle(),
    { icon: 'measure', primary: true, title: 'Click two points (key M)', keys: 'M' });
  const list = h('ul', { class: 'list' });
  let shown = '';
  return {
    element: h('div', {}, group('', start), list,
      h('p', { class: 'hint' }, 'Lengths are in units of the scene. The dashed lines are the components along x, y and z.')),
    refresh(/** @type {Settings} */ { measures }) {
      start.setAttribute('aria-pressed', String(tool.active));
      const state = JSON.stringify([measures, chosen]);
      if (state === shown) return;
      shown = state;
      list.replaceChildren(...measures.map((measure, i) => {
        const choose = button('', () => { chosen = i; ui.refresh(); overlay.redraw(); });
        choose.className = 'item';
        choose.setAttribute('aria-pressed', String(i === chosen));
        const parts = componentsOf(measure).map((x, axis) =>
          h('span', { class: `axis-${'xyz'[axis]}` }, `${'xyz'[axis]} ${text(x)}`));
        choose.append(h('strong', {}, text(distance(measure.from, measure.to))), h('span', { class: 'parts' }, ...parts));
        return h('li', {}, choose, button(`Delete measure ${i + 1}`, () => {
          chosen = Math.max(0, Math.min(chosen, measures.length - 2));
          viewer.set({ measures: measures.filter((_, k) => k !== i) }, 'ui');
        }, { icon: 'trash', bare: true }));
      }));
    },
    tool,
  };
}
