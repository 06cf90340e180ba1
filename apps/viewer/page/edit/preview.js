/** Draws the brush on the surface under the pointer. */
import { EDGES, cornerOf } from '../box.js';
import { add, addScaled, cross, normalized, scale, sub } from '../math.js';
import { svg, update } from '../ui/dom.js';
import { pathOf, show } from '../ui/overlay.js';

/** @typedef {import('../math.js').Vec3} Vec3 */

const CORNERS = 48;

/** Returns points of a circle. @param {Vec3} center @param {Vec3} axis @param {number} radius */
function circle(center, axis, radius) {
  const n = normalized(axis), u = normalized(cross(n, Math.abs(n[0]) < 0.9 ? [1, 0, 0] : [0, 1, 0])), v = cross(n, u);
  return Array.from({ length: CORNERS }, (_, i) => {
    const angle = 2 * Math.PI * i / CORNERS;
    return add(center, add(scale(u, radius * Math.cos(angle)), scale(v, radius * Math.sin(angle))));
  });
}

/** Makes the preview: `at` shows the brush at a hit, or hides it. @param {import('../ui/interface.js').Ui} ui @param {() => import('./brush.js').Brush} brush */
export function makePreview(ui, brush) {
  /** @type {import('../viewer_types.js').Hit | null} */
  let hit = null;
  const paths = [svg('path', { class: 'brush halo' }), svg('path', { class: 'brush' })], layer = svg('g', { class: 'brush-layer' }, ...paths);
  ui.overlay.add((projection) => {
    show(layer, hit !== null);
    if (!hit) return;
    const { shape, radius, verb, color } = brush(), { position, face } = hit, ones = /** @type {Vec3} */ ([1, 1, 1]);
    const box = { low: addScaled(position, ones, -radius), high: addScaled(position, ones, radius) };
    /** @type {Vec3} */
    const normal = [0, 0, 0];
    if (face >= 0) normal[face >> 1] = 1;
    const lines = shape === 'box' ? EDGES.map(([a, b]) => pathOf(projection.clipped([cornerOf(box, a), cornerOf(box, b)], false)))
      : [sub(projection.camera.eye, position), ...(face >= 0 ? [normal] : [])].map((axis) => pathOf(projection.clipped(circle(position, axis, radius), true), true));
    for (const path of paths) update(path, { d: lines.join('') });
    /** @type {SVGElement} */ (paths[1]).style.stroke = verb === 'remove' ? '' : color ?? '';
  }, layer);
  return {
    at(/** @type {import('../viewer_types.js').Hit | null} */ now) {
      hit = now;
      ui.overlay.redraw();
    },
  };
}
