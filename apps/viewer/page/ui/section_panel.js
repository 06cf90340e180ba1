/**
 * The panel "Section", and its handles in the picture: a box that keeps what is inside, and a plane
 * that removes the side to which its arrow points.
 */
import { RADIANS, addScaled, clamp, cross, dot, length, normalized, rotated, roundTo3, scale, stepBelow, sub } from '../math.js';
import { anglesOf, compassOf, directionOf } from '../hands/pose.js';
import { button, group, refreshAll, slider, toggle } from './controls.js';
import { h, svg, update } from './dom.js';
import { lengthText } from './numbers.js';
import { EDGES, cornerOf, cutPolygon, makeHandle, pathOf, place, show } from './overlay.js';

/**
 * @typedef {import('./interface.js').Ui} Ui
 * @typedef {import('../math.js').Vec3} Vec3
 * @typedef {import('../settings.js').Settings} Settings
 * @typedef {import('../settings.js').Box} Box
 * @typedef {import('../settings.js').Plane} Plane
 * @typedef {import('./overlay.js').Projection} Projection
 */

const AXES = ['x', 'y', 'z'];
/** Pixels of the plane's arrow. */
const ARROW = 58;

/** Returns a box with one of its six faces moved: it keeps a size above zero. @param {Box} box @param {number} face @param {number} value @param {number} least @returns {Box} */
export function withFace(box, face, value, least) {
  const axis = face >> 1, low = /** @type {Vec3} */ ([...box.low]), high = /** @type {Vec3} */ ([...box.high]);
  if (face & 1) high[axis] = Math.max(value, low[axis] + least);
  else low[axis] = Math.min(value, high[axis] - least);
  return { low, high };
}

/** Turns a pixel near a ball into a unit vector: right, up, towards the viewer. @param {number} x @param {number} y @returns {Vec3} */
export function ballVector(x, y) {
  const r = Math.hypot(x, y);
  return r < 1 ? [x, y, Math.sqrt(1 - r * r)] : [x / r, y / r, 0];
}

/** @param {Ui} ui */
export function sectionPanel(ui) {
  const { viewer, overlay } = ui;
  const bounds = () => viewer.info?.bounds ?? { low: /** @type {Vec3} */ ([0, 0, 0]), high: /** @type {Vec3} */ ([1, 1, 1]) };
  const size = () => length(sub(bounds().high, bounds().low)) || 1;
  const voxel = () => viewer.info?.voxelSize ?? 1;
  /** Sections are rounded to a hundredth of a voxel: links stay short. */
  const step = () => stepBelow(voxel(), 0.01);
  const text = (/** @type {number} */ x) => lengthText(x, voxel());
  const setBox = (/** @type {Box | null} */ box) =>
    viewer.set({ section: { box: box && { low: roundTo3(box.low, step()), high: roundTo3(box.high, step()) } } }, 'ui');
  const setPlane = (/** @type {Plane | null} */ plane) =>
    viewer.set({ section: { plane: plane && { point: roundTo3(plane.point, step()), normal: roundTo3(plane.normal, -5) } } }, 'ui');
  const firstBox = () => {
    const { low, high } = bounds();
    return { low: addScaled(low, sub(high, low), -0.01), high: addScaled(high, sub(high, low), 0.01) };
  };
  const firstPlane = () => {
    const { low, high } = bounds(), { eye, target, up } = viewer.get().camera ?? ui.home();
    const line = sub(eye, target), flat = addScaled(line, normalized(up), -dot(line, normalized(up)));
    // The axis that points at the viewer best: one looks into the opened scene.
    const away = length(flat) > 0.2 * length(line) ? flat : line;
    const axis = away.map(Math.abs).indexOf(Math.max(...away.map(Math.abs)));
    const normal = /** @type {Vec3} */ ([0, 0, 0]);
    normal[axis] = Math.sign(away[axis]) || 1;
    return { point: scale([low[0] + high[0], low[1] + high[1], low[2] + high[2]], 0.5), normal };
  };

  // The box in the picture.
  const edges = svg('path', { class: 'section-line' });
  const boxGroup = svg('g', {}, edges);
  const faces = [0, 1, 2, 3, 4, 5].map((face) => {
    const axis = face >> 1, handle = svg('g', { class: `handle axis-${AXES[axis]}` }, svg('circle', { class: 'reach', r: 18 }), svg('circle', { r: 7 }));
    /** @type {{box: Box, at: number, y: number, pixel: number} | null} */
    let held = null;
    const value = (/** @type {Box} */ box) => (face & 1 ? box.high : box.low)[axis];
    const unit = /** @type {Vec3} */ ([0, 0, 0]);
    unit[axis] = 1;
    const reach = (/** @type {Box} */ box, /** @type {import('./overlay.js').Spot} */ spot) =>
      overlay.projection?.along(faceMiddle(box, face), unit, spot.x, spot.y) ?? null;
    makeHandle(handle, {
      label: `Box, ${face & 1 ? 'high' : 'low'} ${AXES[axis]}`,
      start(spot) {
        const { box } = viewer.get().section, { projection } = overlay;
        held = box && projection && { box, at: reach(box, spot) ?? 0, y: spot.y, pixel: projection.pixel(faceMiddle(box, face)) };
      },
      drag(spot) {
        if (!held) return;
        const along = reach(held.box, spot), moved = along === null ? (held.y - spot.y) * held.pixel : along - held.at;
        const { low, high } = firstBox(), slack = size() * 0.05;
        setBox(withFace(held.box, face, clamp(value(held.box) + moved, low[axis] - slack, high[axis] + slack), voxel()));
      },
      key(steps, aside) {
        const { box } = viewer.get().section;
        if (box) setBox(withFace(box, face, value(box) + (steps + aside) * size() * 0.005, voxel()));
      },
    });
    boxGroup.append(handle);
    return handle;
  });
  overlay.add((projection, { section: { box } }) => {
    show(boxGroup, box !== null);
    if (!box) return;
    update(edges, { d: EDGES.map(([a, b]) => pathOf(projection.clipped([cornerOf(box, a), cornerOf(box, b)], false))).join('') });
    faces.forEach((handle, face) => {
      place(handle, projection.at(faceMiddle(box, face)));
      update(handle, { 'aria-valuenow': String((face & 1 ? box.high : box.low)[face >> 1]), 'aria-valuetext': text((face & 1 ? box.high : box.low)[face >> 1]) });
    });
  }, boxGroup);

  // The plane in the picture.
  const sheet = svg('path', { class: 'section-sheet' });
  const ring = svg('circle', { class: 'ring', r: ARROW });
  const shaft = svg('line', { class: 'shaft' });
  const middle = svg('g', { class: 'handle' }, svg('circle', { class: 'reach', r: 18 }), svg('rect', { x: -7, y: -7, width: 14, height: 14, rx: 3 }));
  const tip = svg('g', { class: 'handle' }, svg('circle', { class: 'reach', r: 18 }), svg('circle', { r: 6 }));
  const turner = svg('g', { class: 'turner' }, svg('circle', { class: 'ring reach', r: ARROW }), ring);
  const planeGroup = svg('g', {}, sheet, turner, shaft, middle, tip);
  /** @type {{plane: Plane, at: number, y: number, pixel: number} | null} */
  let pushed = null;
  const alongNormal = (/** @type {Plane} */ plane, /** @type {import('./overlay.js').Spot} */ spot) =>
    overlay.projection?.along(plane.point, normalized(plane.normal), spot.x, spot.y) ?? null;
  makeHandle(middle, {
    label: 'Plane, position along its normal',
    start(spot) {
      const { plane } = viewer.get().section, { projection } = overlay;
      pushed = plane && projection && { plane, at: alongNormal(plane, spot) ?? 0, y: spot.y, pixel: projection.pixel(plane.point) };
    },
    drag(spot) {
      if (!pushed) return;
      const along = alongNormal(pushed.plane, spot), moved = along === null ? (pushed.y - spot.y) * pushed.pixel : along - pushed.at;
      movePlane(pushed.plane, moved);
    },
    key(steps, aside) {
      const { plane } = viewer.get().section;
      if (plane) movePlane(plane, (steps + aside) * size() * 0.005);
    },
  });
  /** @param {Plane} plane @param {number} by */
  const movePlane = (plane, by) => {
    const { normal } = plane, unit = normalized(normal), { low, high } = bounds();
    // It stays where it can cut.
    const reach = [0, 1, 2, 3, 4, 5, 6, 7].map((corner) => dot(unit, sub(cornerOf({ low, high }, corner), plane.point)));
    setPlane({ point: addScaled(plane.point, unit, clamp(by, Math.min(...reach, 0), Math.max(...reach, 0))), normal });
  };
  for (const handle of [tip, turner]) {
    /** @type {{plane: Plane, from: Vec3} | null} */
    let held = null;
    const onBall = (/** @type {import('./overlay.js').Spot} */ spot, /** @type {Plane} */ plane, /** @type {boolean} */ behind) => {
      const center = overlay.projection?.at(plane.point);
      const v = ballVector((spot.x - (center?.x ?? 0)) / ARROW, ((center?.y ?? 0) - spot.y) / ARROW);
      return toWorld(behind ? [v[0], v[1], -v[2]] : v);
    };
    const toWorld = (/** @type {Vec3} */ v) => {
      const lens = overlay.projection?.lens;
      return lens ? addScaled(addScaled(scale(lens.right, v[0]), lens.up, v[1]), lens.forward, -v[2]) : v;
    };
    let behind = false;
    makeHandle(handle, {
      label: handle === tip ? 'Plane, direction of its normal' : 'Plane, turn',
      start(spot) {
        const { plane } = viewer.get().section, { projection } = overlay;
        behind = handle === tip && plane !== null && projection !== null && dot(plane.normal, projection.lens.forward) > 0;
        held = plane && { plane, from: onBall(spot, plane, behind) };
      },
      drag(spot) {
        if (!held) return;
        const to = onBall(spot, held.plane, behind), axis = cross(held.from, to), sine = length(axis);
        if (sine < 1e-9) return;
        const turned = rotated(normalized(held.plane.normal), normalized(axis), Math.atan2(sine, dot(held.from, to)));
        setPlane({ point: held.plane.point, normal: snapped(turned) });
      },
      key(steps, aside) {
        const { plane } = viewer.get().section, { up } = viewer.get().camera ?? ui.home();
        if (!plane) return;
        const compass = compassOf(up), { yaw, pitch } = anglesOf(compass, normalized(plane.normal));
        setPlane({ ...plane, normal: directionOf(compass, yaw + steps * 2 * RADIANS, clamp(pitch + aside * 2 * RADIANS, -Math.PI / 2, Math.PI / 2)) });
      },
    });
  }
  turner.setAttribute('tabindex', '-1');  // the tip is the one that keys turn
  overlay.add((projection, { section: { plane } }) => {
    const center = plane && projection.at(plane.point);
    show(planeGroup, plane !== null);
    if (!plane) return;
    update(sheet, { d: pathOf(projection.clipped(cutPolygon(bounds(), plane), true), true) });
    for (const part of [middle, turner]) place(part, center);
    place(tip, center);
    show(shaft, center !== null);
    if (!center) return;
    const n = normalized(plane.normal), { right, up } = projection.lens;
    const x = center.x + dot(n, right) * ARROW, y = center.y - dot(n, up) * ARROW;
    place(tip, { x, y });
    update(shaft, { x1: center.x, y1: center.y, x2: x, y2: y });
    update(middle, { 'aria-valuenow': String(dot(n, plane.point)), 'aria-valuetext': text(dot(n, plane.point)) });
    update(tip, { 'aria-valuenow': String(Math.round(anglesOf(compassOf(projection.camera.up), n).yaw / RADIANS)), 'aria-valuetext': plane.normal.map((v) => v.toFixed(2)).join(', ') });
  }, planeGroup);

  // The panel.
  const boxOn = toggle({ label: 'Box', get: (s) => s.section.box !== null, set: (on) => setBox(on ? firstBox() : null) });
  const sides = [0, 1, 2, 3, 4, 5].map((face) => {
    const axis = face >> 1;
    return slider({
      label: `${face & 1 ? 'High' : 'Low'} ${AXES[axis]}`, min: 0, max: 1, get: (s) => (s.section.box ? (face & 1 ? s.section.box.high : s.section.box.low)[axis] : 0), text,
      set: (value) => { const { box } = viewer.get().section; if (box) setBox(withFace(box, face, value, voxel())); },
    });
  });
  const planeOn = toggle({ label: 'Plane', get: (s) => s.section.plane !== null, set: (on) => setPlane(on ? firstPlane() : null) });
  const offsetOf = (/** @type {Plane} */ plane) => dot(normalized(plane.normal), plane.point);
  const offset = slider({
    label: 'Position', min: 0, max: 1, get: (s) => (s.section.plane ? offsetOf(s.section.plane) : 0), text,
    set: (value) => { const { plane } = viewer.get().section; if (plane) movePlane(plane, value - offsetOf(plane)); },
  });
  const axes = h('div', { class: 'grid' }, ...[0, 1, 2].map((axis) => button(`⟂ ${AXES[axis]}`, () => {
    const { plane } = viewer.get().section, normal = /** @type {Vec3} */ ([0, 0, 0]);
    const { eye, target } = viewer.get().camera ?? ui.home();
    normal[axis] = Math.sign(eye[axis] - target[axis]) || 1;
    if (plane) setPlane({ point: plane.point, normal });
  }, { title: `Across the ${AXES[axis]} axis` })), button('Flip', () => {
    const { plane } = viewer.get().section;
    if (plane) setPlane({ point: plane.point, normal: scale(plane.normal, -1) });
  }));
  const boxPart = h('div', {}, ...sides.map((side) => side.element), h('div', { class: 'buttons' }, button('Whole scene', () => setBox(firstBox()))));
  const planePart = h('div', {}, offset.element, axes);
  const refresh = refreshAll([boxOn, planeOn]);
  return {
    element: h('div', {}, group('', boxOn.element, boxPart), group('', planeOn.element, planePart),
      h('p', { class: 'hint' }, 'Drag the handles in the picture. The box keeps what is inside it; the plane removes the side of its arrow.')),
    refresh(/** @type {Settings} */ settings) {
      const { box, plane } = settings.section, { low, high } = firstBox();
      refresh(settings);
      boxPart.hidden = box === null;
      planePart.hidden = plane === null;
      sides.forEach((side, face) => side.limits(low[face >> 1], high[face >> 1]));
      if (box) refreshAll(sides)(settings);
      if (!plane) return;
      const unit = normalized(plane.normal);
      const reach = [0, 1, 2, 3, 4, 5, 6, 7].map((corner) => dot(unit, cornerOf({ low, high }, corner)));
      offset.limits(Math.min(...reach), Math.max(...reach));
      offset.refresh(settings);
    },
    /** Switches the plane. */
    toggle: () => setPlane(viewer.get().section.plane ? null : firstPlane()),
  };
}

/** @param {Box} box @param {number} face @returns {Vec3} */
function faceMiddle({ low, high }, face) {
  const middle = scale([low[0] + high[0], low[1] + high[1], low[2] + high[2]], 0.5);
  middle[face >> 1] = (face & 1 ? high : low)[face >> 1];
  return middle;
}

/** Returns the axis within three degrees of a unit vector, or the vector. @param {Vec3} v @returns {Vec3} */
function snapped(v) {
  const axis = v.findIndex((x) => Math.abs(x) > Math.cos(3 * RADIANS));
  if (axis < 0) return v;
  const n = /** @type {Vec3} */ ([0, 0, 0]);
  n[axis] = Math.sign(v[axis]);
  return n;
}
