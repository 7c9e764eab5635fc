// To the program that serves this page: a websocket, taken up again when it is lost.
'use strict';

/// `take` is told every message, a text or an ArrayBuffer; `lost` that there is nobody any more.
class Connection {
  constructor(take, lost) {
    const token = new URLSearchParams(window.location.search).get('token');
    if (token) window.history.replaceState(null, '', '/');  // the cookie has it now
    this.take = take;
    this.lost = lost;
    this.open();
  }

  open() {
    this.socket = new WebSocket(`ws://${window.location.host}/stream`);
    this.socket.binaryType = 'arraybuffer';
    this.socket.onmessage = (event) => this.take(event.data);
    this.socket.onclose = () => {
      this.lost();
      setTimeout(() => this.open(), 1000);
    };
  }

  send(text) {
    if (this.socket.readyState === WebSocket.OPEN) this.socket.send(text);
  }
}
