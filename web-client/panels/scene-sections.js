import { say, written } from '../base/texts.js';
import { byName, choice, color, facts, numbers, range, selection, toggle } from './controls.js';

/**
 * @import { Control } from './controls.js'
 * @import { Now } from './menu.js'
 * @import { StateDocument } from '../base/protocol.js'
 */

const STYLES = [['vrut', 'VRUT'], ['maya', 'Maya'], ['catia', 'CATIA'], ['cinema4d', 'Cinema 4D']];

/** The five sections of the thesis (chapter 6.9), bound to the state. */
export function sceneSections({ change, state }) {
  return [scene(), renderer(change), camera(change), light(change, state), background(change, state)];
}

/**
 * `bound` are pairs of a control and what it shows, by the state and all else that the page knows.
 *
 * @param {string} name
 * @param {string} title
 * @param {...[Control, (state: StateDocument, now: Now) => *[]]} bound
 */
function section(name, title, ...bound) {
  return {
    name,
    title,
    content: bound.map(([control]) => control.element),
    show(now) {
      for (const [control, values] of bound) control.show(...values(now.state, now));
    },
  };
}

function scene() {
  const about = facts({
    name: say('fact.name'),
    nodes: say('scene.nodes'),
    materials: say('scene.materials'),
    geometries: say('scene.geometries'),
  });
  return section('scene', say('scene.title'), [about, (state) => [state.scene]]);
}

function renderer(change) {
  const set = (member) => (value) => change({ renderer: { [member]: value } });
  const get = (member) => (state) => [state.renderer[member]];
  const modes = [['realistic', say('renderer.realistic')], ['stylized', say('renderer.stylized')]];
  const about = facts({
    solid: say('renderer.opaque'),
    transparent: say('renderer.transparent'),
    reflective: say('renderer.reflective'),
    time: say('renderer.time'),
  });
  return section('renderer', say('renderer.title'),
    [choice(say('renderer.mode'), modes, set('mode')), get('mode')],
    [toggle(say('renderer.wireframe'), set('wireframe')), get('wireframe')],
    [toggle(say('renderer.showSelection'), set('showSelection')), get('showSelection')],
    [about, (state, { stats }) => {
      const mean = stats?.renderer?.meanRenderMs;
      return [{ ...state.renderer, time: mean && `${written(mean, 1)} ms` }];
    }]);
}

function camera(change) {
  const set = (member) => (value) => change({ navigation: { [member]: value } });
  const get = (member) => (state) => [state.navigation[member]];
  const about = facts({
    name: say('fact.name'),
    id: say('fact.id'),
    near: say('camera.near'),
    far: say('camera.far'),
    plane: say('camera.plane'),
  });
  const degrees = { min: 1, max: 170, say: (value) => `${written(value, 1)}°` };
  const fov = range(say('camera.fov'), degrees, (value) => change({ camera: { fov: value } }));
  const factor = { min: 0.01, max: 100, logarithmic: true, step: 0.05, say: (value) => `${written(value, 2)} ×` };
  /** @returns {[Control, (state: StateDocument) => *[]]} */
  const speed = (label, member) => [range(label, factor, set(member)), get(member)];
  return section('camera', say('camera.title'),
    [about, ({ camera: now }, { header }) =>
      [{ name: say('camera.free'), ...now, id: now.node?.toString(), plane: planeSize(now, header?.view) }]],
    [fov, (state) => [state.camera.fov]],
    speed(say('camera.rotateSpeed'), 'rotateSpeed'),
    speed(say('camera.panSpeed'), 'panSpeed'),
    speed(say('camera.zoomSpeed'), 'zoomSpeed'),
    [toggle(say('camera.keepUpright'), set('keepUpright')), get('keepUpright')],
    [toggle(say('camera.turnAboutTouched'), (on) => set('turnAbout')(on ? 'touched' : 'center')),
      (state) => [state.navigation.turnAbout === 'touched']],
    [selection(say('camera.style'), set('style')), (state) => [state.navigation.style, STYLES]]);
}

/** Of the near plane, in the scene's unit. */
function planeSize({ fov, near }, view) {
  if (!view) return undefined;
  const height = 2 * near * Math.tan((fov * Math.PI) / 360);
  return `${written((height * view.width) / view.height, 3)} × ${written(height, 3)}`;
}

function light(change, present) {
  const types = {
    headlight: say('light.headlight'),
    point: say('light.point'),
    spot: say('light.spot'),
    directional: say('light.directional'),
  };
  const set = (member) => (value) => change({ lights: { items: { [present().lights.active]: { [member]: value } } } });
  const get = (member) => ({ lights }) => [lights.items[lights.active][member]];
  const parts = [say('light.constant'), say('light.linear'), say('light.quadratic')];
  return section('light', say('light.title'),
    [selection(say('light.active'), (active) => change({ lights: { active } })),
      ({ lights: { active, items: { headlight, ...others } } }) =>
        [active, [['headlight', types.headlight], ...options(others)]]],
    [facts({ name: say('fact.name'), id: say('fact.id'), type: say('fact.type') }),
      ({ lights: { active, items } }) => {
        const { name, type } = items[active];
        const named = active === 'headlight' ? { name: types.headlight } : { name, id: active };
        return [{ ...named, type: types[type] }];
      }],
    [color(say('fact.color'), set('color')), get('color')],
    [numbers(say('light.attenuation'), parts, set('attenuation')), get('attenuation')]);
}

function background(change, present) {
  const plain = say('background.plain');
  const setColor = (value) => {
    const { active } = present().backgrounds;
    return change({ backgrounds: active === 'color' ? { color: value } : { items: { [active]: { color: value } } } });
  };
  return section('background', say('background.title'),
    [selection(say('background.active'), (active) => change({ backgrounds: { active } })),
      ({ backgrounds: { active, items } }) => [active, [['color', plain], ...options(items)]]],
    [facts({ name: say('fact.name'), id: say('fact.id'), texture: say('background.texture') }),
      ({ backgrounds: { active, items } }) =>
        [active === 'color' ? { name: plain } : { ...items[active], id: active }]],
    [color(say('fact.color'), setColor), ({ backgrounds: all }) => [(all.items[all.active] ?? all).color]]);
}

function options(items) {
  return Object.entries(items).map(([key, { name }]) => [key, name]).sort(([, a], [, b]) => byName(a, b));
}
