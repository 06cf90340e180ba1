/** The handles of the section in the picture: six faces of the box; the plane, its arrow and its ring. */
import {
  RADIANS, addScaled, clamp, cross, dot, length, normalized, rotated, roundTo3, scale, stepBelow, sub,
} from '../math.js';
import { EDGES, cornerOf, cutPolygon, faceMiddle, faceValue, rangeAlong, withFace } from '../box.js';
import { anglesOf, compassOf, directionOf } from '../hands/pose.js';
import { svg, update } from './dom.js';
import { lengthText } from './numbers.js';
import { makeHandle, pathOf, place, show } from './overlay.js';

/**
 * @typedef {import('./interface.js').Ui} Ui
 * @typedef {import('../math.js').Vec3} Vec3
 * @typedef {import('../settings.js').Box} Box
 * @typedef {import('../settings.js').Plane} Plane
 * @typedef {import('./overlay.js').Spot} Spot
 */

export const AXES = ['x', 'y', 'z'];
/** Pixels of the plane's arrow. */
const ARROW = 58;
/** The part of the scene's size that an arrow key moves. */
const KEY_STEP = 0.005;
/** Degrees that an arrow key turns, and within which the normal snaps to an axis. */
const KEY_TURN = 2, SNAP = 3;

/** @param {number} axis @param {number} [sign] @returns {Vec3} */
export function axisVector(axis, sign = 1) {
  const v = /** @type {Vec3} */ ([0, 0, 0]);
  v[axis] = sign;
  return v;
}

/**
 * Turns a place on a ball of radius 1 into a unit vector: right, up, towards the viewer. Places
 * beside the ball give its outline.
 * @param {number} x @param {number} y @returns {Vec3}
 */
export function ballVector(x, y) {
  const r = Math.hypot(x, y);
  return r < 1 ? [x, y, Math.sqrt(1 - r * r)] : [x / r, y / r, 0];
}

/** Returns the axis next to a unit vector, or the vector if none is near. @param {Vec3} v @returns {Vec3} */
function snapped(v) {
  const axis = v.findIndex((x) => Math.abs(x) > Math.cos(SNAP * RADIANS));
  return axis < 0 ? v : axisVector(axis, Math.sign(v[axis]));
}

/** Draws the section and its handles. Returns what the panel needs too. @param {Ui} ui */
export function sectionHandles(ui) {
  const { viewer, overlay } = ui;
  const voxel = () => viewer.info?.voxelSize ?? 1;
  /** @returns {Box} */
  const bounds = () => viewer.info?.bounds ?? { low: [0, 0, 0], high: [1, 1, 1] };
  /** The box at first: a little more than the scene. @returns {Box} */
  const wholeBox = () => {
    const { low, high } = bounds(), size = sub(high, low);
    return { low: addScaled(low, size, -0.01), high: addScaled(high, size, 0.01) };
  };
  const size = () => length(sub(bounds().high, bounds().low)) || 1;
  /** Rounded to a hundredth of a voxel: links stay short. @param {Vec3} point */
  const rounded = (point) => roundTo3(point, stepBelow(voxel(), 0.01));
  const setBox = (/** @type {Box | null} */ box) =>
    viewer.set({ section: { box: box && { low: rounded(box.low), high: rounded(box.high) } } }, 'ui');
  const setPlane = (/** @type {Plane | null} */ plane) =>
    viewer.set({ section: { plane: plane && { point: rounded(plane.point), normal: roundTo3(plane.normal, -5) } } }, 'ui');
  const text = (/** @type {number} */ x) => lengthText(x, voxel());

  /** Moves the plane along its normal; it stays where it can cut. @param {Plane} plane @param {number} way */
  const movePlane = ({ point, normal }, way) => {
    const unit = normalized(normal), [low, high] = rangeAlong(bounds(), unit), at = dot(unit, point);
    setPlane({ point: addScaled(point, unit, clamp(way, Math.min(low - at, 0), Math.max(high - at, 0))), normal });
  };

  /**
   * Makes a handle that moves along a line. If the line points at the camera, up and down move it.
   * @template T
   * @param {Element} element @param {string} label
   * @param {{state: () => T | null, line: (state: T) => [Vec3, Vec3], move: (state: T, way: number) => void}} acts
   *   `line`: a point and a unit vector.
   */
  const makeSlider = (element, label, { state, line, move }) => {
    /** @type {{state: T, at: number, y: number, pixel: number} | null} */
    let held = null;
    const along = (/** @type {T} */ now, /** @type {Spot} */ spot) =>
      overlay.projection?.along(...line(now), spot.x, spot.y) ?? null;
    makeHandle(element, {
      label,
      start(spot) {
        const now = state(), { projection } = overlay;
        held = now && projection && { state: now, at: along(now, spot) ?? 0, y: spot.y, pixel: projection.pixel(line(now)[0]) };
      },
      drag(spot) {
        if (!held) return;
        const place = along(held.state, spot);
        move(held.state, place === null ? (held.y - spot.y) * held.pixel : place - held.at);
      },
      key(aside, up) {
        const now = state();
        if (now) move(now, (aside + up) * size() * KEY_STEP);
      },
    });
  };

  // The box.
  const edges = svg('path', { class: 'section-line' });
  const boxGroup = svg('g', {}, edges);
  const faces = [0, 1, 2, 3, 4, 5].map((face) => {
    const axis = face >> 1;
    const handle = svg('g', { class: `handle axis-${AXES[axis]}` }, svg('circle', { class: 'reach', r: 18 }), svg('circle', { r: 7 }));
    makeSlider(handle, `Box, ${face & 1 ? 'high' : 'low'} ${AXES[axis]}`, {
      state: () => viewer.get().section.box,
      line: (box) => [faceMiddle(box, face), axisVector(axis)],
      move(box, way) {
        const { low, high } = wholeBox(), slack = size() * 0.05;
        setBox(withFace(box, face, clamp(faceValue(box, face) + way, low[axis] - slack, high[axis] + slack), voxel()));
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
      update(handle, { 'aria-valuenow': String(faceValue(box, face)), 'aria-valuetext': text(faceValue(box, face)) });
    });
  }, boxGroup);

  // The plane.
  const sheet = svg('path', { class: 'section-sheet' });
  const shaft = svg('line', { class: 'shaft' });
  const square = { x: -7, y: -7, width: 14, height: 14, rx: 3 };
  const middle = svg('g', { class: 'handle' }, svg('circle', { class: 'reach', r: 18 }), svg('rect', square));
  const tip = svg('g', { class: 'handle' }, svg('circle', { class: 'reach', r: 18 }), svg('circle', { r: 6 }));
  const ring = svg('g', { class: 'turner' }, svg('circle', { class: 'ring reach', r: ARROW }), svg('circle', { class: 'ring', r: ARROW }));
  const planeGroup = svg('g', {}, sheet, ring, shaft, middle, tip);
  makeSlider(middle, 'Plane, position along its normal', {
    state: () => viewer.get().section.plane,
    line: ({ point, normal }) => [point, normalized(normal)],
    move: movePlane,
  });
  for (const handle of [tip, ring]) {
    // The normal turns as a ball under the pointer does.
    /** @type {{plane: Plane, from: Vec3, isBehind: boolean} | null} */
    let held = null;
    const onBall = (/** @type {Spot} */ spot, /** @type {Plane} */ plane, /** @type {boolean} */ isBehind) => {
      const { projection } = overlay, center = projection?.at(plane.point);
      if (!projection || !center) return plane.normal;
      const [x, y, z] = ballVector((spot.x - center.x) / ARROW, (center.y - spot.y) / ARROW), { right, up, forward } = projection.lens;
      return addScaled(addScaled(scale(right, x), up, y), forward, isBehind ? z : -z);
    };
    makeHandle(handle, {
      label: handle === tip ? 'Plane, direction of its normal' : 'Plane, turn',
      start(spot) {
        const { plane } = viewer.get().section, { projection } = overlay;
        if (!plane || !projection) return;
        const isBehind = handle === tip && dot(plane.normal, projection.lens.forward) > 0;
        held = { plane, from: onBall(spot, plane, isBehind), isBehind };
      },
      drag(spot) {
        if (!held) return;
        const { plane, from, isBehind } = held, to = onBall(spot, plane, isBehind), axis = cross(from, to), sine = length(axis);
        if (sine < 1e-9) return;
        const turned = rotated(normalized(plane.normal), normalized(axis), Math.atan2(sine, dot(from, to)));
        setPlane({ point: plane.point, normal: snapped(turned) });
      },
      key(aside, up) {
        const { plane } = viewer.get().section, compass = compassOf(viewer.camera().up), step = KEY_TURN * RADIANS;
        if (!plane) return;
        const { yaw, pitch } = anglesOf(compass, normalized(plane.normal));
        setPlane({ ...plane, normal: directionOf(compass, yaw + aside * step, clamp(pitch + up * step, -Math.PI / 2, Math.PI / 2)) });
      },
    });
  }
  ring.setAttribute('tabindex', '-1');  // the tip is the one that keys turn
  overlay.add((projection, { section: { plane } }) => {
    show(planeGroup, plane !== null);
    if (!plane) return;
    update(sheet, { d: pathOf(projection.clipped(cutPolygon(bounds(), plane), true), true) });
    const center = projection.at(plane.point), n = normalized(plane.normal), { right, up } = projection.lens;
    const end = center && { x: center.x + dot(n, right) * ARROW, y: center.y - dot(n, up) * ARROW };
    for (const part of [middle, ring]) place(part, center);
    place(tip, end);
    show(shaft, center !== null);
    if (!center || !end) return;
    update(shaft, { x1: center.x, y1: center.y, x2: end.x, y2: end.y });
    const at = dot(n, plane.point), { yaw } = anglesOf(compassOf(projection.camera.up), n);
    update(middle, { 'aria-valuenow': String(at), 'aria-valuetext': text(at) });
    update(tip, { 'aria-valuenow': String(Math.round(yaw / RADIANS)), 'aria-valuetext': n.map((x) => x.toFixed(2)).join(', ') });
  }, planeGroup);

  return { voxel, bounds, wholeBox, setBox, setPlane, movePlane, text };
}
