"""Pages of DAGs in notebooks and browsers."""
import atexit
import html
import http.server
import os
import secrets
import sys
import threading
import warnings
import webbrowser


class Frame:
    """A page in a frame, which notebooks display."""

    def __init__(self, page, width, height):
        self._page, self._width, self._height = page, width, height

    def __repr__(self):
        return (f"<voxdag: a page of {len(self._page):,} bytes, which notebooks display; view() opens it "
                "in a browser>")

    def _repr_html_(self):
        width, height = (html.escape(str(side)) for side in (self._width, self._height))
        return (f'<iframe width="{width}" height="{height}" style="border:0" allowfullscreen '
                f'srcdoc="{html.escape(self._page)}"></iframe>')


class View:
    """A page that this process serves to the browsers of this machine, until close() or its end.

    url: its address, which holds a secret: nobody else on this machine can guess it. A `with` block
    closes the page at its end.
    """

    def __init__(self, page, open_browser):
        path = f"/{secrets.token_urlsafe(12)}/"
        sent = self._sent = threading.Event()

        class Handler(http.server.BaseHTTPRequestHandler):
            def do_GET(self):
                if self.path.split("?")[0] != path:
                    return self.send_error(404)
                self.send_response(200)
                self.send_header("Content-Type", "text/html; charset=utf-8")
                self.send_header("Content-Length", str(len(page)))
                self.send_header("Cache-Control", "no-store")
                self.end_headers()
                self.wfile.write(page)
                sent.set()

            def log_message(self, *_):
                pass

        self._server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        self.url = f"http://127.0.0.1:{self._server.server_port}{path}"
        threading.Thread(target=self._server.serve_forever, daemon=True).start()
        if open_browser:
            if _has_display() and webbrowser.open(self.url):
                # A script may end before the browser has read the page.
                atexit.register(sent.wait, 10)
            else:
                warnings.warn(f"no browser opened: open {self.url}", stacklevel=3)

    def close(self):
        """Ends the server. A browser that shows the page keeps it."""
        if self._server is not None:
            atexit.unregister(self._sent.wait)
            self._server.shutdown()
            self._server.server_close()
            self._server = None

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def __repr__(self):
        return f"<voxdag: {self.url}, {'closed' if self._server is None else 'until close()'}>"


def _has_display():
    """Returns whether browsers can open a window. Without one, webbrowser starts browsers of text."""
    return (not sys.platform.startswith("linux") or
            any(os.environ.get(name) for name in ("DISPLAY", "WAYLAND_DISPLAY", "BROWSER")))
