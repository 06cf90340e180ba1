/**
 * The numbers that the shaders need for a view with its settings: the port of render/camera.hpp,
 * light.cpp and render_plan.cpp. Lengths are in units of the grid's side.
 */
import { LIGHT } from '../constants.js';
import { CLEAR_LUMINANCE, environmentOf, mapAxes } from '../environment.js';
import { lensOf } from '../lens.js';
import { distance, dot, length, normalized, scale, sub } from '../math.js';
import { interiorSun } from '../sun.js';
import { sunOf } from '../sunlight.js';

/** @typedef {import('../settings.js').Camera} Camera */
/** @typedef {import('../settings.js').Settings & {camera: Camera}} Settings */
/** @typedef {import('../math.js').Vec3} Vec3 */
/** @typedef {{origin: Vec3, side: number, bounds: import('../settings.js').Box, home: (Camera & {sun?: Vec3}) | null}} Place where the grid is, in world units */

/** Returns the uniforms of camera.glsl. @param {Place} place @param {Camera} camera @param {number} width @param {number} height  Pixels. */
export function cameraUniforms(place, camera, width, height) {
  const { forward, right, up, tanX, tanY } = lensOf(camera, width / height);
  const eye = /** @type {Vec3} */ (camera.eye.map((x, a) => {
    const p = (x - place.origin[a]) / place.side;
    // Inside the grid all rays start at this point, rounded as in trace/grid_ray.hpp.
    return p >= 0 && p <= 1 ? Math.fround(1 + p) - 1 : p;
  }));
  return {
    u_eye: eye, u_forward: forward, u_right: scale(right, tanX), u_up: scale(up, tanY),
    u_size: [width, height], u_pixel_size: (2 * tanY) / height,
  };
}

/** Returns the uniforms of sky.glsl. @param {Place} place @param {Settings} settings */
export function skyUniforms(place, settings) {
  const { environment: { map, turn }, sky } = settings, up = normalized(settings.camera.up, [0, 1, 0]);
  const environment = environmentOf(map), [right, , back] = mapAxes(up, turn), { direction, light } = sunOf(place, settings);
  return {
    u_sun: direction, u_sun_light: light,
    u_zenith: LIGHT.zenith.map((x) => x * sky), u_horizon: LIGHT.horizon.map((x) => x * sky), u_ground: LIGHT.ground.map((x) => x * sky),
    u_sky_up: up, u_map_right: right, u_map_back: back, u_map_scale: sky,
    u_harmonics: environment ? environment.harmonics.flatMap((h) => scale(h, sky)) : Array(27).fill(0),
    u_sky_exposure: environment ? CLEAR_LUMINANCE / environment.luminance : 1,
  };
}

/** Returns the uniforms of shade.glsl and light.glsl that settings and camera determine. @param {Place} place @param {Settings} settings */
export function lightUniforms(place, settings) {
  const { camera, occlusion } = settings, inside = interiorSun(place, camera), sun = sunOf(place, settings).direction;
  const sign = sun[2] < 0 ? -1 : 1;
  const a = -1 / (sign + sun[2]), b = sun[0] * sun[1] * a;
  const radius = Math.tan((settings.sun.angle * Math.PI) / 360);
  return {
    u_sun_u: scale([1 + sign * sun[0] * sun[0] * a, sign * b, -sign * sun[0]], radius),
    u_sun_v: scale([b, sign + sun[1] * sun[1] * a, -sun[1]], radius),
    u_fill: lensOf(camera, 1).right,
    u_albedo: LIGHT.albedo,
    u_occlusion_distance: occlusion.distance > 0 ? occlusion.distance / place.side : inside ? LIGHT.interiorOcclusion : LIGHT.occlusionDistance,
    u_occlusion_cone: Math.sqrt(occlusion.cone),
  };
}

/** Returns the period of the lines on cut faces, in grid sides: hatch_period() of render/hatch.hpp. @param {Place} place @param {Settings} settings */
export function hatchPeriod(place, { camera, section }) {
  const height = 2 * lensOf(camera, 1).tanY * distance(camera.eye, camera.target) / place.side;
  return section.hatch ? 2 ** Math.round(Math.log2(height / LIGHT.hatchPeriods)) : 0;
}

/** Returns the part of the grid that the section keeps. @param {Place} place @param {Settings['section']} section */
export function sectionUniforms(place, section) {
  const inGrid = (/** @type {Vec3} */ p) => p.map((x, a) => 1 + (x - place.origin[a]) / place.side);
  const plane = section.plane;
  const normal = plane === null ? /** @type {Vec3} */ ([0, 0, 0]) : normalized(plane.normal, [0, 1, 0]);
  return {
    u_section_low: section.box === null ? [-1e9, -1e9, -1e9] : inGrid(section.box.low),
    u_section_high: section.box === null ? [1e9, 1e9, 1e9] : inGrid(section.box.high),
    u_section_plane: [...normal, plane === null ? 0 : dot(normal, /** @type {Vec3} */ (inGrid(plane.point)))],
  };
}

/** Returns the uniforms of the ground: none in an interior or a section, or if no axis points up. @param {Place} place @param {Settings} settings */
export function groundUniforms(place, settings) {
  const { camera, section, ground } = settings, { low, high } = place.bounds;
  const up = normalized(camera.up, [0, 1, 0]), axis = up.indexOf(1);
  const isOn = ground && axis >= 0 && section.box === null && section.plane === null && interiorSun(place, camera) === null;
  const middle = low.map((x, a) => ((a === axis ? x : (x + high[a]) / 2) - place.origin[a]) / place.side);
  return { u_ground_middle: middle, u_ground_up: up, u_ground_radius: isOn ? length(sub(high, low)) / place.side : 0 };
}
