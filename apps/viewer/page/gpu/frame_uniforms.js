/**
 * The numbers that the shaders need for a view with its settings: the port of render/camera.hpp,
 * light.cpp and render_plan.cpp. Lengths are in units of the grid's side.
 */
import { LIGHT } from '../constants.js';
import { add, cross, dot, normalized, scale, sub } from '../math.js';

/** @typedef {import('../settings.js').Camera} Camera */
/** @typedef {import('../settings.js').Settings & {camera: Camera}} Settings */
/** @typedef {import('../math.js').Vec3} Vec3 */
/** @typedef {{origin: Vec3, side: number}} Place where the grid is, in world units */

/**
 * @param {Place} place @param {Camera} camera @param {number} width @param {number} height pixels
 */
export function cameraUniforms(place, camera, width, height) {
  const forward = normalized(sub(camera.target, camera.eye), [0, 0, -1]);
  const right = normalized(cross(forward, camera.up), [1, 0, 0]);
  const halfHeight = Math.tan((camera.fov * Math.PI) / 360);
  const eye = /** @type {Vec3} */ (camera.eye.map((x, a) => {
    const p = (x - place.origin[a]) / place.side;
    // Inside the grid all rays start at this point, rounded as in trace/grid_ray.hpp.
    return p >= 0 && p <= 1 ? Math.fround(1 + p) - 1 : p;
  }));
  return {
    u_eye: eye, u_forward: forward, u_right: scale(right, (halfHeight * width) / height), u_up: scale(cross(right, forward), halfHeight),
    u_size: [width, height], u_pixel_size: (2 * halfHeight) / height,
  };
}

/** Returns the unit vector to the sun. @param {Settings} settings @returns {Vec3} */
export function sunDirection(settings) {
  if (settings.sun.direction !== null) return normalized(settings.sun.direction, [0, 1, 0]);
  const { eye, target, up } = settings.camera;
  const upward = normalized(up, [0, 1, 0]);
  const right = normalized(cross(normalized(sub(target, eye), [0, 0, -1]), up), [1, 0, 0]);
  const back = cross(right, upward);
  return normalized(add(add(scale(right, LIGHT.defaultSun[0]), scale(upward, LIGHT.defaultSun[1])), scale(back, LIGHT.defaultSun[2])));
}

/** @param {Place} place @param {Settings} settings */
export function lightUniforms(place, settings) {
  const sun = sunDirection(settings);
  const sign = sun[2] < 0 ? -1 : 1;
  const a = -1 / (sign + sun[2]), b = sun[0] * sun[1] * a;
  const radius = Math.tan((settings.sun.angle * Math.PI) / 360);
  const { camera, occlusion } = settings;
  const forward = normalized(sub(camera.target, camera.eye), [0, 0, -1]);
  return {
    u_sun: sun,
    u_sun_u: scale([1 + sign * sun[0] * sun[0] * a, sign * b, -sign * sun[0]], radius),
    u_sun_v: scale([b, sign + sun[1] * sun[1] * a, -sun[1]], radius),
    u_sun_light: settings.sun.on ? LIGHT.sunLight : [0, 0, 0],
    u_zenith: LIGHT.zenith.map((x) => x * settings.sky), u_horizon: LIGHT.horizon.map((x) => x * settings.sky),
    u_ground: LIGHT.ground.map((x) => x * settings.sky),
    u_sky_up: normalized(camera.up, [0, 1, 0]), u_fill: normalized(cross(forward, camera.up), [1, 0, 0]),
    u_albedo: LIGHT.albedo,
    u_occlusion_distance: occlusion.distance > 0 ? occlusion.distance / place.side : LIGHT.occlusionDistance,
    u_occlusion_cone: Math.sqrt(occlusion.cone),
  };
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
