import { say, written } from '../../base/texts.js';
import { byName, choice, color, facts, numbers, range, selection, toggle } from '../controls.js';
import { section, stateOf } from '../section.js';

/**
 * @import { StateDocument } from '../../base/protocol.js'
 * @import { Control } from '../controls.js'
 * @import { Page } from '../section.js'
 */

/** @type {Record<StateDocument['navigation']['style'], string>} */
const STYLES = { vrut: 'VRUT', maya: 'Maya', catia: 'CATIA', cinema4d: 'Cinema 4D' };

/**
 * The five sections of the thesis (chapter 6.9), bound to the state.
 *
 * @param {Page} page
 */
export function sceneSections({ commands: { change }, store }) {
  const present = () => stateOf(store);
  return [scene(), renderer(change), camera(change), light(change, present), background(change, present)];
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
    [about, (state, { stats }) => [state.renderer, stats?.renderer?.meanRenderMs], rendererFacts]);
}

/** @param {StateDocument['renderer']} renderer @param {number} [meanRenderMs] */
export function rendererFacts(renderer, meanRenderMs) {
  return [{ ...renderer, time: meanRenderMs && written(meanRenderMs, 1, 'ms') }];
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
    [about, ({ camera: { name, node, near, far, fov: angle } }, { header }) =>
      [name, node, near, far, angle, header?.view.width, header?.view.height], cameraFacts],
    [fov, (state) => [state.camera.fov]],
    speed(say('camera.rotateSpeed'), 'rotateSpeed'),
    speed(say('camera.panSpeed'), 'panSpeed'),
    speed(say('camera.zoomSpeed'), 'zoomSpeed'),
    [toggle(say('camera.keepUpright'), set('keepUpright')), get('keepUpright')],
    [toggle(say('camera.turnAboutTouched'), (on) => set('turnAbout')(on ? 'touched' : 'center')),
      (state) => [state.navigation.turnAbout === 'touched']],
    [selection(say('camera.style'), set('style')), (state) => [state.navigation.style],
      (style) => [style, Object.entries(STYLES)]]);
}

/** The plane is the near one, its size in the scene's unit, and known once a picture is. */
export function cameraFacts(name = say('camera.free'), node, near, far, fov, viewWidth, viewHeight) {
  const height = 2 * near * Math.tan((fov * Math.PI) / 360);
  const plane = viewWidth && `${written((height * viewWidth) / viewHeight, 3)} × ${written(height, 3)}`;
  return [{ name, id: node?.toString(), near, far, plane }];
}

function light(change, present) {
  const set = (member) => (value) => change({ lights: { items: { [present().lights.active]: { [member]: value } } } });
  const get = (member) => ({ lights }) => [lights.items[lights.active][member]];
  const parts = [say('light.constant'), say('light.linear'), say('light.quadratic')];
  return section('light', say('light.title'),
    [selection(say('light.active'), (active) => change({ lights: { active } })),
      (state) => [state.lights], lightChoice],
    [facts({ name: say('fact.name'), id: say('fact.id'), type: say('fact.type') }),
      (state) => [state.lights], lightFacts],
    [color(say('fact.color'), set('color')), get('color')],
    [numbers(say('light.attenuation'), parts, set('attenuation')), get('attenuation')]);
}

function lightTypes() {
  return {
    headlight: say('light.headlight'),
    point: say('light.point'),
    spot: say('light.spot'),
    directional: say('light.directional'),
  };
}

/** The active one, and all. @param {StateDocument['lights']} lights */
export function lightChoice({ active, items: { headlight, ...others } }) {
  return [active, [['headlight', say('light.headlight')], ...options(others)]];
}

/** @param {StateDocument['lights']} lights */
export function lightFacts({ active, items }) {
  const { name, type } = items[active];
  const types = lightTypes();
  const named = active === 'headlight' ? { name: types.headlight } : { name, id: active };
  return [{ ...named, type: types[type] }];
}

function background(change, present) {
  const setColor = (value) => {
    const { active } = present().backgrounds;
    return change({ backgrounds: active === 'color' ? { color: value } : { items: { [active]: { color: value } } } });
  };
  return section('background', say('background.title'),
    [selection(say('background.active'), (active) => change({ backgrounds: { active } })),
      (state) => [state.backgrounds], backgroundChoice],
    [facts({ name: say('fact.name'), id: say('fact.id'), texture: say('background.texture') }),
      (state) => [state.backgrounds], backgroundFacts],
    [color(say('fact.color'), setColor), ({ backgrounds: all }) => [(all.items[all.active] ?? all).color]]);
}

/** The active one, and all. @param {StateDocument['backgrounds']} backgrounds */
export function backgroundChoice({ active, items }) {
  return [active, [['color', say('background.plain')], ...options(items)]];
}

/** @param {StateDocument['backgrounds']} backgrounds */
export function backgroundFacts({ active, items }) {
  return [active === 'color' ? { name: say('background.plain') } : { ...items[active], id: active }];
}

/** @param {Record<string, {name: string}>} items */
function options(items) {
  return Object.entries(items).map(([key, { name }]) => [key, name]).sort(([, a], [, b]) => byName(a, b));
}
