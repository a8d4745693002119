import { recall, remember } from './base/memory.js';
import { Store } from './base/store.js';
import { language, preferredLanguage, setLanguage } from './base/texts.js';
import { commandsBy } from './connection/commands.js';
import { Connection, socketAddress } from './connection/connection.js';
import { fetchFile } from './connection/files.js';
import { Token, hello } from './connection/hello.js';
import { Meter } from './connection/meter.js';
import { Bar } from './panels/bar.js';
import { Menu } from './panels/menu.js';
import { Awake } from './stage/awake.js';
import { Stage } from './stage/stage.js';

const store = new Store();
const meter = new Meter();
const awake = new Awake();
const token = new Token(location.hash);

const connection = new Connection({
  url: socketAddress(document.baseURI),
  hello: () => ({ ...hello(location.hash, token.value), depth: stage.warps }),
  on: {
    phase(phase) {
      const { role, client, steers } = connection;
      store.set({ phase, role, client, steers, hasPicture: false, stats: null });
      meter.forgetSent();
      stage.phase();
      // A link to watch is not to take the presenter's place.
      if (phase.name === 'open' && (role === 'control' || !recall('token'))) token.accepted();
    },
    async frame(frame) {
      const header = await stage.draw(frame);
      if (!header) return;
      meter.drawn(header.handled, frame.data.byteLength, performance.now());
      store.set({ header, hasPicture: true });
    },
    sent(message) {
      stage.sent(message);
      bar.sent(message);
      // What one who does not steer sends moves nothing.
      if (connection.steers) meter.sent(message.type, message.id, performance.now());
    },
    state(state) {
      store.set({ state, revision: connection.revision, steers: connection.steers });
      stage.follow(state);
    },
    error: (error) => stage.inputRefused(error),
    message(message) {
      if (message.type === 'stats') store.set({ stats: message });
      else if (message.type === 'loading') stage.loading(message);
      else if (message.type === 'pointed') stage.pointed(message);
    },
  },
});
const report = (error) => stage.report(error);
const commands = commandsBy({
  ask: (message) => connection.ask(message), refused: report, late: (isLate) => store.set({ isLate }),
});
const stage = new Stage({ store, commands, connection, meter, hasToken: token.inAddress });
const offer = (text, label, act) => stage.offer(text, label, act);
const nextTap = (text, signal) => stage.nextTap(text, signal);
const { snapping, turnPointing } = stage;
const menu = new Menu({
  store, commands, meter, report, offer, nextTap, snapping, turnPointing, present: () => bar.present(), setLanguage: speak,
  fetchFile: (name) => fetchFile(name, token.value),
});
const bar = new Bar({ store, commands, menu, report, offer, turnPointing });

store.subscribe(({ role }) => [role === 'control'], (wanted) => Object.assign(awake, { wanted }));

/** What the user chose, or else the browser's. */
async function speak(chosen) {
  if (chosen) remember('language', chosen);
  const wanted = chosen ?? recall('language') ?? preferredLanguage(navigator.languages);
  await setLanguage(wanted).catch(() => report({ code: 'not-loaded' }));
  store.set({ language: language() });
  menu.rebuild();
  bar.rebuild();
}

for (const type of ['visibilitychange', 'online']) {
  window.addEventListener(type, () => document.hidden || connection.wake());
}
// Another token: another start.
window.addEventListener('hashchange', () => location.reload());

speak();
connection.start();
