delete globalThis.fetch;  // Node would look for the module in the web.
