/** Where the sun is, and how bright: the port of make_sky() and sun_color() in render/render_plan.cpp. */
import { LIGHT } from './constants.js';
import { CLEAR_LUMINANCE, environmentOf, mapAxes } from './environment.js';
import { lensOf } from './lens.js';
import { add, addScaled, cross, length, normalized, scale } from './math.js';

/**
 * @typedef {import('./math.js').Vec3} Vec3
 * @typedef {import('./settings.js').Camera} Camera
 * @typedef {import('./settings.js').Settings & {camera: Camera}} Settings
 * @typedef {{bounds: import('./settings.js').Box, home: (Camera & {sun?: Vec3}) | null}} Place
 */

/**
 * Returns the sun of an interior, if the scene is one and the camera is in it; else null.
 * @param {Place} place @param {Camera} camera
 */
export const interiorSun = ({ bounds, home }, camera) =>
  (home?.sun && camera.eye.every((x, a) => x > bounds.low[a] && x < bounds.high[a]) ? home.sun : null);

/**
 * Returns the unit vector towards the sun, and its irradiance divided by pi. Without a direction of the settings it is the sun
 * of the environment; under the clear sky that of the interior, or one that turns with the camera.
 * @param {Place} place @param {Settings} settings @returns {{direction: Vec3, light: Vec3}}
 */
export function sunOf(place, { camera, sun, environment: { map, turn } }) {
  const environment = environmentOf(map), up = normalized(camera.up, [0, 1, 0]);
  const has = environment !== null && length(environment.sun) > 0;
  let light = /** @type {Vec3} */ (LIGHT.sunLight);
  if (has) light = scale(environment.sun, 1 / Math.PI);
  else if (environment) light = sun.direction ? scale(light, environment.luminance / CLEAR_LUMINANCE) : [0, 0, 0];
  if (!sun.on) light = [0, 0, 0];
  let direction = sun.direction;
  if (direction === null && environment) {
    const [x, y, z] = mapAxes(up, turn), at = environment.towards;
    direction = has ? add(addScaled(scale(x, at[0]), y, at[1]), scale(z, at[2])) : up;
  }
  direction ??= interiorSun(place, camera);
  if (direction) return { direction: normalized(direction, [0, 1, 0]), light };
  const { right } = lensOf(camera, 1), usual = LIGHT.defaultSun;
  return { direction: normalized(addScaled(addScaled(scale(right, usual[0]), up, usual[1]), cross(right, up), usual[2])), light };
}
