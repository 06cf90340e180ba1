/** The sun of a picture, with an environment or the clear sky: the port of make_sky() and sun_color() in render/render_plan.cpp. */
import { LIGHT } from './constants.js';
import { CLEAR_LUMINANCE, environmentOf, mapAxes } from './environment.js';
import { add, addScaled, length, normalized, scale } from './math.js';
import { interiorSun, sunDirection } from './sun.js';

/**
 * @typedef {import('./math.js').Vec3} Vec3
 * @typedef {import('./settings.js').Settings & {camera: import('./settings.js').Camera}} Settings
 */

/**
 * Returns the unit vector towards the sun, and its irradiance divided by pi. Without a direction of the settings it is the sun
 * of the environment; under the clear sky that of the interior, or one that turns with the camera.
 * @param {Parameters<typeof interiorSun>[0]} place @param {Settings} settings @returns {{direction: Vec3, light: Vec3}}
 */
export function sunOf(place, { camera, sun, environment: { map, turn } }) {
  const environment = environmentOf(map);
  let { direction } = sun, light = /** @type {Vec3} */ (LIGHT.sunLight);
  if (environment === null) {
    direction ??= interiorSun(place, camera);
  } else {
    const has = length(environment.sun) > 0, up = normalized(camera.up, [0, 1, 0]), [x, y, z] = mapAxes(up, turn), at = environment.towards;
    if (has) light = scale(environment.sun, 1 / Math.PI);
    else light = direction ? scale(light, environment.luminance / CLEAR_LUMINANCE) : [0, 0, 0];
    direction ??= has ? add(addScaled(scale(x, at[0]), y, at[1]), scale(z, at[2])) : up;
  }
  return { direction: sunDirection(direction, camera, LIGHT.defaultSun), light: sun.on ? light : [0, 0, 0] };
}
