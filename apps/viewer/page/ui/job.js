/** Long work that the user started: shows how much is done, and a button that cancels it. */
import { button } from './controls.js';
import { h, say } from './dom.js';

/**
 * What a job may use: `signal` ends it, and `progress` takes the part that is done, from 0 to 1.
 * @typedef {{signal: AbortSignal, progress: (part: number) => void}} Job
 */

/**
 * Makes the function that runs jobs, one at a time. It returns whether the job has finished: false if it was cancelled, has
 * failed, or another one runs; it tells the user in each case.
 * @param {HTMLElement} container @param {(text: string, isError?: boolean) => void} toast
 * @returns {(label: string, work: (job: Job) => Promise<void>) => Promise<boolean>}
 */
export function makeJobs(container, toast) {
  /** @type {AbortController | null} */
  let control = null;
  const text = h('span', {}), bar = h('progress', { max: 1, value: 0, 'aria-label': 'Done' });
  const element = h('div', { class: 'job', hidden: true, role: 'status' }, text, bar, button('Cancel', () => control?.abort()));
  container.append(element);
  return async (label, work) => {
    if (control) {
      toast('Wait for the work that runs, or cancel it');
      return false;
    }
    const { signal } = (control = new AbortController());
    const progress = (/** @type {number} */ part) => {
      bar.value = part;
      say(text, `${label} ${Math.floor(100 * part)}%`);
    };
    progress(0);
    element.hidden = false;
    try {
      await work({ signal, progress });
      return true;
    } catch (error) {
      if (signal.aborted) toast('Cancelled');
      else toast(`${label}: ${error instanceof Error ? error.message : error}`, true);
      return false;
    } finally {
      control = null;
      element.hidden = true;
    }
  };
}
