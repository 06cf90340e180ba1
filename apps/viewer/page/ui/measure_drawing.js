/** The drawing of measures over the picture. */
import { addScaled, dot, normalized, sub } from '../math.js';
import { middleOf } from '../box.js';
import { keeps } from '../section_ray.js';
import { say, svg, update } from './dom.js';
import { pathOf, place, show } from './overlay.js';

/**
 * @typedef {import('../math.js').Vec3} Vec3
 * @typedef {import('../settings.js').Measure} Measure
 * @typedef {import('./overlay.js').Projection} Projection
 */

/** Makes the elements of a measure: its line with a halo, its surface, dots at its points, components and label. */
function newShape() {
  const halo = svg('path', { class: 'halo' }), line = svg('path', { class: 'measure-line' });
  const steps = ['x', 'y', 'z'].map((axis) => svg('path', { class: `measure-step axis-${axis}` }));
  const dots = [svg('path', { class: 'measure-dots halo' }), svg('path', { class: 'measure-dots' })];
  const label = svg('text', { class: 'label', 'text-anchor': 'middle', dy: -8 });
  return { element: svg('g', { class: 'measure' }, ...steps, halo, line, ...dots, label), halo, line, steps, dots, label };
}

/** Returns the corners of the dashed lines: along the axes, or level to the end of a height. @param {Measure} measure @param {Vec3} up @returns {Vec3[]} */
function stepsOf({ kind, points: [from, to] }, up) {
  if (kind === 'distance') return [from, [to[0], from[1], from[2]], [to[0], to[1], from[2]], to];
  return kind === 'height' ? [addScaled(from, up, dot(sub(to, from), up)), to] : [];
}

/** Returns the point at which the label stands. @param {Measure} measure @param {Vec3} up @returns {Vec3} */
function labelPoint({ kind, points }, up) {
  const [from, to] = points, last = points[points.length - 1];
  if (kind === 'path') return last;
  if (kind === 'angle') return to ?? from;
  if (kind === 'height') return addScaled(from, up, dot(sub(to, from), up) / 2);
  if (kind === 'distance') return middleOf({ low: from, high: to });
  return /** @type {Vec3} */ ([0, 1, 2].map((axis) => points.reduce((sum, p) => sum + p[axis], 0) / points.length));
}

/**
 * Draws measures into a layer of the overlay; `chosen` is the one whose components are drawn.
 * @param {import('./interface.js').Ui} ui @param {(measure: Measure) => string} text
 * @param {() => {measures: Measure[], chosen: number}} shown
 */
export function drawMeasures(ui, text, shown) {
  /** @type {ReturnType<typeof newShape>[]} */
  const shapes = [];
  const layer = svg('g', {});
  ui.overlay.add((projection, { section }) => {
    const { measures, chosen } = shown(), up = normalized(projection.camera.up), slack = ui.viewer.info?.voxelSize ?? 0;
    while (shapes.length < measures.length) layer.append(shapes[shapes.push(newShape()) - 1].element);
    shapes.forEach((shape, i) => {
      const measure = measures[i];
      show(shape.element, measure !== undefined);
      if (!measure) return;
      const { kind, points } = measure, isClosed = kind === 'area' && points.length > 2;
      const line = kind === 'height' ? [points[0], addScaled(points[0], up, dot(sub(points[1], points[0]), up))] : points;
      const path = pathOf(projection.clipped(line, isClosed), isClosed);
      for (const part of [shape.line, shape.halo]) update(part, { d: path });
      shape.line.classList.toggle('measure-area', isClosed);
      // A line of no length with round ends is a dot.
      const dots = points.map((point) => projection.at(point)).map((spot) => (spot ? `M${spot.x.toFixed(1)} ${spot.y.toFixed(1)}h0` : '')).join('');
      for (const part of shape.dots) update(part, { d: dots });
      const steps = i === chosen || kind === 'height' ? stepsOf(measure, up) : [];
      shape.steps.forEach((step, axis) => update(step, { d: pathOf(projection.clipped(steps.slice(axis, axis + 2), false)) }));
      shape.element.classList.toggle('cut-away', !points.some((point) => keeps(section, point, slack)));
      place(shape.label, points.length > 1 ? projection.at(labelPoint(measure, up)) : null);
      say(shape.label, text(measure));
    });
  }, layer);
}
