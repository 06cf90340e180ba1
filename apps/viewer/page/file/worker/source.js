/** Bytes of a file on a server. Part of the worker's script: see scene_loader.js. */

/** An error that the page shows: a short title, and what happened and what to do. */
class SceneError extends Error {
  /** @param {string} title @param {string} text */
  constructor(title, text) {
    super(text);
    this.title = title;
  }
}

/** @param {string} text @returns {SceneError} */
function brokenFile(text) {
  return new SceneError('This file is damaged', text);
}

/**
 * A file on a server. Asks for parts; if the server sends the whole file instead, takes the parts
 * from it as they arrive.
 */
class ServerSource {
  /** @param {string} url */
  constructor(url) {
    this.url = url;
    this.size = 0;
    this.requests = 0;
    this.version = '';
    /** @type {Uint8Array | null} */
    this.whole = null;
    this.arrived = 0;
    /** @type {SceneError | null} */
    this.failure = null;
    /** @type {(() => void)[]} */
    this.waiting = [];
  }

  /** Asks for the first bytes and finds the size. @param {number} count @returns {Promise<Uint8Array>} */
  async open(count) {
    const response = await this.request(0, count - 1);
    if (response.status === 206) {
      const range = /^bytes 0-(\d+)\/(\d+)$/.exec(response.headers.get('Content-Range') || '');
      const bytes = new Uint8Array(await this.body(response));
      if (range === null) throw new SceneError('The answer of the server is wrong', `${this.url}: no valid Content-Range.`);
      this.size = Number(range[2]);
      return bytes;
    }
    this.size = Number(response.headers.get('Content-Length') || 0);
    if (response.headers.get('Content-Encoding')) this.size = 0;
    await this.takeWhole(response);
    const bytes = new Uint8Array(Math.min(count, this.size || count));
    await this.wait(bytes.length);
    return /** @type {Uint8Array} */ (this.whole).slice(0, Math.min(bytes.length, this.arrived));
  }

  /** @param {number} first @param {number} last @returns {Promise<Response>} */
  async request(first, last) {
    for (let attempt = 0; ; ++attempt) {
      try {
        ++this.requests;
        const response = await fetch(this.url, { headers: { Range: `bytes=${first}-${last}` } });
        if (response.status !== 200 && response.status !== 206)
          throw new SceneError('The scene was not found', `${this.url}: the server answers ${response.status}.`);
        const version = response.headers.get('ETag') || response.headers.get('Last-Modified') || '';
        if (this.version !== '' && version !== this.version)
          throw new SceneError('The file has changed', 'It changed on the server while it was being loaded. Load the page again.');
        this.version = version;
        return response;
      } catch (error) {
        if (error instanceof SceneError) throw error;
        if (attempt === 3) throw new SceneError('No connection', `${this.url} cannot be reached. Levels that have arrived stay visible.`);
        await new Promise((resolve) => setTimeout(resolve, 250 << attempt));
      }
    }
  }

  /** @param {Response} response @returns {Promise<ArrayBuffer>} */
  async body(response) {
    try {
      return await response.arrayBuffer();
    } catch {
      throw new SceneError('No connection', `${this.url}: the connection broke. Levels that have arrived stay visible.`);
    }
  }

  /** Begins to take the whole file from a response. @param {Response} response */
  async takeWhole(response) {
    if (response.body === null || this.size === 0) {
      this.whole = new Uint8Array(await this.body(response));
      this.size = this.arrived = this.whole.length;
      return;
    }
    const whole = (this.whole = new Uint8Array(this.size));
    const reader = response.body.getReader();
    const pump = async () => {
      try {
        for (;;) {
          const { done, value } = await reader.read();
          if (done) break;
          if (this.arrived + value.length > whole.length) throw new Error('more bytes than announced');
          whole.set(value, this.arrived);
          this.arrived += value.length;
          this.wake();
        }
        if (this.arrived < whole.length) throw new Error('fewer bytes than announced');
      } catch {
        this.failure = new SceneError('No connection', `${this.url}: the connection broke. Levels that have arrived stay visible.`);
      }
      this.wake();
    };
    pump();
  }

  wake() {
    for (const resolve of this.waiting.splice(0)) resolve();
  }

  /** Waits until `end` bytes of the whole file have arrived. @param {number} end */
  async wait(end) {
    while (this.arrived < end) {
      if (this.failure !== null) throw this.failure;
      await new Promise((resolve) => this.waiting.push(() => resolve(undefined)));
    }
  }

  /** Fills `target` from `offset`. @param {Uint8Array} target @param {number} offset */
  async read(target, offset) {
    const end = offset + target.length;
    if (end > this.size) throw brokenFile(`The file ends at byte ${this.size}, but its contents go on to byte ${end}.`);
    if (target.length === 0) return;
    if (this.whole !== null) {
      await this.wait(end);
      target.set(this.whole.subarray(offset, end));
      return;
    }
    const response = await this.request(offset, end - 1);
    const bytes = new Uint8Array(await this.body(response));
    if (response.status === 200) {
      this.whole = bytes;
      this.arrived = bytes.length;
      if (bytes.length < end) throw brokenFile(`The file ends at byte ${bytes.length}.`);
      target.set(bytes.subarray(offset, end));
      return;
    }
    if (bytes.length !== target.length)
      throw new SceneError('The answer of the server is wrong', `${this.url}: ${bytes.length} bytes instead of ${target.length}.`);
    target.set(bytes);
  }
}
