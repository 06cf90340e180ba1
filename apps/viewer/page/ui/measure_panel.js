/** The panel "Measure": lengths, areas, angles and heights between points that one picks, drawn in the picture. */
import { distance, normalized, roundTo3, stepBelow } from '../math.js';
import { alongAxis, pathLength, unitFactor, valueOf } from '../measures.js';
import { MEASURE_POINTS, UNITS } from '../settings.js';
import { button, choice, group } from './controls.js';
import { h } from './dom.js';
import { drawMeasures } from './measure_drawing.js';
import { lengthText } from './numbers.js';

/**
 * @typedef {import('./interface.js').Ui} Ui
 * @typedef {import('../math.js').Vec3} Vec3
 * @typedef {import('../settings.js').Settings} Settings
 * @typedef {import('../settings.js').Measure} Measure
 * @typedef {import('../settings.js').MeasureKind} MeasureKind
 * @typedef {import('../settings.js').Unit} Unit
 */

/** @type {[MeasureKind, string][]} */
const KINDS = [['distance', 'Distance'], ['path', 'Path'], ['area', 'Area'], ['angle', 'Angle'], ['height', 'Height']];
/** @type {{[kind in MeasureKind]: string[]}} Hints for the first points; the last one for all others. */
const HINTS = {
  distance: ['Click the first point', 'Click the second point. Shift keeps to an axis'],
  path: ['Click the first point', 'Click the next point. Enter or a double click ends the path'],
  area: ['Click the first corner', 'Click the next corner. Enter or a double click closes the area'],
  angle: ['Click a point of the first side', 'Click the corner of the angle', 'Click a point of the second side'],
  height: ['Click the lower point', 'Click the upper point'],
};

/** @param {Ui} ui */
export function measurePanel(ui) {
  const { viewer, overlay } = ui;
  const voxel = () => viewer.info?.voxelSize ?? 1, own = () => viewer.info?.unit ?? null, unit = () => viewer.get().unit ?? own();
  const up = () => normalized(viewer.camera().up);
  const rounded = (/** @type {Vec3} */ point) => roundTo3(point, stepBelow(voxel(), 0.001));
  /** Returns a length of the scene as text. @param {number} x */
  const lengthOf = (x) => lengthText(x * unitFactor(own(), unit()), voxel() * 0.1 * unitFactor(own(), unit()));
  /** The unit's name behind a value. */
  const unitName = () => (own() ? ' ' + unit() : '');
  /** Returns the value with its unit. @param {Measure} measure */
  const text = (measure) => {
    const value = valueOf(measure, up()), name = unitName();
    if (measure.points.length < MEASURE_POINTS[measure.kind][0]) return '';
    if (measure.kind === 'angle') return `${value.toFixed(1)}°`;
    if (measure.kind !== 'area') return lengthOf(value) + name;
    const square = unitFactor(own(), unit()) ** 2;
    return lengthText(value * square, Math.max(voxel() * 0.1 * Math.sqrt(value), voxel() ** 2 * 0.01) * square) + (name && name + '²');
  };

  /** The kind that the tool makes. @type {MeasureKind} */
  let kind = 'distance';
  /** The points that are picked, while more are wanted, and where the pointer is. @type {Vec3[]} */
  let open = [];
  /** @type {Vec3 | null} */
  let pointer = null;
  let isShift = false;
  /** The measure whose components are drawn. */
  let chosen = 0;
  for (const type of ['keydown', 'keyup', 'pointerdown', 'pointermove'])
    window.addEventListener(type, (event) => { isShift = /** @type {KeyboardEvent | PointerEvent} */ (event).shiftKey; }, { capture: true });
  const placed = (/** @type {Vec3} */ point) => rounded(isShift && open.length > 0 ? alongAxis(open[open.length - 1], point) : point);

  drawMeasures(ui, text, () => {
    const { measures } = viewer.get(), begun = pointer && open.length > 0 ? [...open, pointer] : open;
    return begun.length > 0 ? { measures: [...measures, { kind: begun.length < 2 ? 'path' : kind, points: begun }], chosen: measures.length } : { measures, chosen };
  });

  const finish = () => {
    const { measures } = viewer.get(), [least] = MEASURE_POINTS[kind];
    if (open.length < least) return false;
    const made = { kind, points: open };
    open = [];
    pointer = null;
    chosen = measures.length;
    viewer.set({ measures: [...measures, made] }, 'ui');
    ui.announce(`${KINDS.find(([name]) => name === kind)?.[1]} ${text(made)}`);
    return true;
  };
  const tool = ui.tool({
    hint: () => HINTS[kind][Math.min(open.length, HINTS[kind].length - 1)],
    click(hit) {
      const point = placed(hit.position), [, most] = MEASURE_POINTS[kind], last = open[open.length - 1];
      pointer = null;
      // The second click of a double click picks the last point again.
      if (last && distance(last, point) < voxel() * 0.01) finish();
      else if (open.push(point) === most) finish();
      overlay.redraw();
    },
    hover(hit) {
      if (open.length === 0 || !hit) return;
      pointer = placed(hit.position);
      overlay.redraw();
    },
    finish,
    end() {
      open = [];
      pointer = null;
      overlay.redraw();
    },
  });

  const kinds = choice({ label: 'Kind', options: KINDS, get: () => kind, set(value) { kind = value; tool.stop(); tool.toggle(); } });
  const units = choice({
    label: 'Unit', options: UNITS.map((name) => /** @type {[Unit, string]} */ ([name, name])),
    get: () => unit() ?? 'm', set: (value) => viewer.set({ unit: value === own() ? null : value }, 'ui'),
  });
  const noUnit = h('p', { class: 'hint' }, 'The file does not say its unit: lengths are in units of the scene. ', h('code', {}, 'voxdag build --unit'), ' stores one.');
  const start = button('Measure', () => { if (!finish()) tool.toggle(); },
    { icon: 'measure', primary: true, title: 'Click points of the scene (key M)', keys: 'M' });
  const list = h('ul', { class: 'list' });
  /** The numbers beside a value. @param {Measure} measure @returns {[string, string][]} */
  const partsOf = ({ kind: of, points }) => {
    if (of === 'distance') return points[1].map((x, i) => [`axis-${'xyz'[i]}`, `${'xyz'[i]} ${lengthOf(Math.abs(x - points[0][i]))}`]);
    if (of === 'area') return [['', `perimeter ${lengthOf(pathLength(points, true))}${unitName()}`]];
    return of === 'path' ? [['', `${points.length} points`]] : [];
  };
  let shown = '';
  return {
    element: h('div', {}, group('', kinds.element, start, units.element, noUnit), list,
      h('p', { class: 'hint' }, 'Hold Shift to keep to an axis. Dashed lines are the components along x, y and z. Measures of parts that a section cuts away are pale.')),
    refresh(/** @type {Settings} */ settings) {
      const { measures } = settings;
      start.setAttribute('aria-pressed', String(tool.active));
      kinds.refresh(settings);
      units.refresh(settings);
      units.element.hidden = own() === null;
      noUnit.hidden = own() !== null || !viewer.info;
      const state = JSON.stringify([measures, chosen, unit(), own(), up()]);
      if (state === shown) return;
      shown = state;
      list.replaceChildren(...measures.map((measure, i) => {
        const name = KINDS.find(([of]) => of === measure.kind)?.[1] ?? '';
        const choose = button('', () => { chosen = i; ui.refresh(); overlay.redraw(); });
        choose.className = 'item';
        choose.setAttribute('aria-pressed', String(i === chosen));
        choose.append(h('strong', {}, text(measure)), h('span', { class: 'kind' }, name),
          h('span', { class: 'parts' }, ...partsOf(measure).map(([axis, part]) => h('span', { class: axis }, part))));
        return h('li', {}, choose, button(`Delete measure ${i + 1}`, () => {
          chosen = Math.max(0, Math.min(chosen, measures.length - 2));
          viewer.set({ measures: measures.filter((_, k) => k !== i) }, 'ui');
        }, { icon: 'trash', bare: true }));
      }));
    },
    tool,
  };
}
