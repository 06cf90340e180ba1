/** Who can open a link to this page, and the code that shows the page in another one. */

/**
 * Returns why others cannot open an address, and what to do instead; an empty text if they can.
 * @param {string} address  An absolute URL.
 */
export function whyNotShared(address) {
  const { protocol, hostname } = new URL(address);
  if (protocol === 'file:') return 'it names a file on this computer. Send the file itself, with saved settings';
  if (protocol !== 'http:' && protocol !== 'https:') return 'this page has no address outside this window. Send the scene and saved settings';
  if (/^(localhost|.*\.localhost|127\.[\d.]+|\[::1\]|0\.0\.0\.0)$/.test(hostname))
    return 'it leads to this computer. To share the scene, send the file of "voxdag export"';
  if (/^(10\.|192\.168\.|169\.254\.|172\.(1[6-9]|2\d|3[01])\.|\[f[cd]|\[fe80:)/.test(hostname) || /\.local$/.test(hostname))
    return 'it leads into this network, and works only there';
  return '';
}

/** Returns an address without the secret that allows edits. @param {string} address  An absolute URL. */
export function withoutSecret(address) {
  const url = new URL(address);
  url.searchParams.delete('edit');
  return url.href;
}

/** Returns HTML that shows an address in another page. @param {string} address @param {string} title */
export function embedCode(address, title) {
  const escaped = (/** @type {string} */ text) => text.replace(/[&"<>]/g, (c) => `&#${c.charCodeAt(0)};`);
  return `<iframe src="${escaped(address)}" title="${escaped(title)}" width="800" height="500" style="border:0;max-width:100%" ` +
    'allow="fullscreen" loading="lazy"></iframe>';
}
