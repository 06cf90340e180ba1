/** The exposure of a picture: the port of render/exposure.cpp. */
import { EXPOSURE } from '../constants.js';

/**
 * Returns the factor that brings surfaces to a medium brightness, with few of them white.
 * @param {Float32Array} pixels sums of samples: red, green, blue, and how many samples hit a surface
 * @param {number} samples in each sum
 */
export function automaticExposure(pixels, samples) {
  const [red, green, blue] = EXPOSURE.luminance;
  const luminances = [];
  let sum = 0;
  for (let i = 0; i < pixels.length; i += 4) {
    if (pixels[i + 3] < 0.5 * samples) continue;
    const luminance = (red * pixels[i] + green * pixels[i + 1] + blue * pixels[i + 2]) / pixels[i + 3];
    if (luminance === 0) continue;  // The ground's shadow.
    luminances.push(luminance);
    sum += Math.log(Math.max(luminance, EXPOSURE.min));
  }
  if (luminances.length === 0) return EXPOSURE.ofNothing;
  luminances.sort((a, b) => a - b);
  const mean = Math.exp(sum / luminances.length);
  const white = Math.max(luminances[Math.min(luminances.length - 1, Math.floor(EXPOSURE.bright * luminances.length))], EXPOSURE.min);
  return Math.min(EXPOSURE.middle / mean, EXPOSURE.white / white, EXPOSURE.most);
}
