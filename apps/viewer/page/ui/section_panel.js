/**
 * The panel "Section": a box that keeps what is inside it, and a plane that removes the side to which
 * its arrow points.
 */
import { addScaled, dot, length, normalized, scale, sub } from '../math.js';
import { faceValue, middleOf, rangeAlong, withFace } from '../box.js';
import { button, group, refreshAll, slider, toggle } from './controls.js';
import { h } from './dom.js';
import { degrees } from './numbers.js';
import { skyAngles, skyDirection } from './sky_angles.js';
import { AXES, axisVector, sectionHandles } from './section_handles.js';

/**
 * @typedef {import('./interface.js').Ui} Ui
 * @typedef {import('../settings.js').Settings} Settings
 * @typedef {import('../settings.js').Plane} Plane
 */

/** @param {Ui} ui */
export function sectionPanel(ui) {
  const { viewer } = ui;
  const { voxel, bounds, wholeBox, setBox, setPlane, movePlane, text } = sectionHandles(ui);
  const section = () => viewer.get().section;

  /** Returns a plane through the middle, across the axis that points at the viewer best: one looks into the scene. */
  const firstPlane = () => {
    const { eye, target } = viewer.camera(), up = normalized(viewer.camera().up), line = sub(eye, target);
    const flat = addScaled(line, up, -dot(line, up)), away = length(flat) > 0.2 * length(line) ? flat : line;
    const sizes = away.map(Math.abs), axis = sizes.indexOf(Math.max(...sizes));
    return { point: middleOf(bounds()), normal: axisVector(axis, Math.sign(away[axis]) || 1) };
  };

  const boxOn = toggle({
    label: 'Box', get: (s) => s.section.box !== null, set: (on) => setBox(on ? wholeBox() : null),
  });
  const sides = [0, 1, 2, 3, 4, 5].map((face) => slider({
    label: `${face & 1 ? 'High' : 'Low'} ${AXES[face >> 1]}`, min: 0, max: 1, text,
    get: (s) => (s.section.box ? faceValue(s.section.box, face) : 0),
    set(value) {
      const { box } = section();
      if (box) setBox(withFace(box, face, value, voxel()));
    },
  }));
  const planeOn = toggle({
    label: 'Plane', get: (s) => s.section.plane !== null, set: (on) => setPlane(on ? firstPlane() : null),
  });
  const offsetOf = (/** @type {Plane} */ plane) => dot(normalized(plane.normal), plane.point);
  const offset = slider({
    label: 'Position', min: 0, max: 1, text, get: (s) => (s.section.plane ? offsetOf(s.section.plane) : 0),
    set(value) {
      const { plane } = section();
      if (plane) movePlane(plane, value - offsetOf(plane));
    },
  });
  /** The direction of the arrow, as angles. */
  const arrow = () => skyAngles(section().plane?.normal ?? [0, 1, 0], viewer.camera().up);
  const aim = (/** @type {number} */ azimuth, /** @type {number} */ elevation) => {
    const { plane } = section();
    if (plane) setPlane({ point: plane.point, normal: skyDirection(azimuth, elevation, viewer.camera().up) });
  };
  const azimuth = slider({
    label: 'Direction of the arrow', min: 0, max: 360, step: 1, text: degrees,
    get: () => arrow().azimuth, set: (value) => aim(value, arrow().elevation),
  });
  const elevation = slider({
    label: 'Height of the arrow', min: -90, max: 90, step: 1, text: degrees,
    // Straight up, the azimuth would be lost.
    get: () => arrow().elevation, set: (value) => aim(arrow().azimuth, Math.max(-89.99, Math.min(value, 89.99))),
  });
  const across = (/** @type {number} */ axis) => button(`⟂ ${AXES[axis]}`, () => {
    const { plane } = section(), { eye, target } = viewer.camera();
    if (plane) setPlane({ point: plane.point, normal: axisVector(axis, Math.sign(eye[axis] - target[axis]) || 1) });
  }, { title: `Cut across the ${AXES[axis]} axis` });
  const flip = button('Flip', () => {
    const { plane } = section();
    if (plane) setPlane({ point: plane.point, normal: scale(plane.normal, -1) });
  });

  const hatch = toggle({
    label: 'Hatching', hint: 'Draws lines on cut faces, which keep their place in the scene',
    get: (s) => s.section.hatch, set: (on) => viewer.set({ section: { hatch: on } }, 'ui'),
  });
  const boxPart = h('div', {}, ...sides.map((side) => side.element),
    h('div', { class: 'buttons' }, button('Whole scene', () => setBox(wholeBox()))));
  const planePart = h('div', {}, offset.element, azimuth.element, elevation.element, h('div', { class: 'grid' }, across(0), across(1), across(2), flip));
  const hatchPart = group('', hatch.element);
  const refresh = refreshAll([boxOn, planeOn, hatch]);
  return {
    element: h('div', {}, group('', boxOn.element, boxPart), group('', planeOn.element, planePart), hatchPart, h('p', { class: 'hint' },
      'Drag the handles in the picture, or type numbers. The box keeps what is inside it. The plane removes the side to which its arrow points.')),
    refresh(/** @type {Settings} */ settings) {
      const { box, plane } = settings.section, { low, high } = wholeBox();
      refresh(settings);
      boxPart.hidden = box === null;
      planePart.hidden = plane === null;
      hatchPart.hidden = box === null && plane === null;
      sides.forEach((side, face) => side.limits(low[face >> 1], high[face >> 1]));
      if (box) refreshAll(sides)(settings);
      if (!plane) return;
      const [least, most] = rangeAlong({ low, high }, normalized(plane.normal));
      offset.limits(least, most);
      refreshAll([offset, azimuth, elevation])(settings);
    },
    /** Switches the plane on or off. */
    toggle: () => setPlane(section().plane ? null : firstPlane()),
  };
}
