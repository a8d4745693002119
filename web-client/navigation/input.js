import { distance } from '../base/vectors.js';

/**
 * @import { StateDocument } from '../base/protocol.js'
 * @import { Camera } from './camera.js'
 * @import { NavigationContext } from './drags.js'
 * @import { Gestures } from './gestures.js'
 */

/**
 * What input means in a view of that size.
 *
 * @param {Pick<StateDocument, 'scene'|'navigation'|'views'>} state
 * @param {{width: number, height: number}} view
 * @param {NavigationContext['surfaceAt']} surfaceAt
 * @returns {NavigationContext}
 */
export function contextOf({ scene, navigation, views }, { width, height }, surfaceAt) {
  const { turnAbout, ...rules } = navigation;
  return {
    ...rules,
    width,
    height,
    radius: distance(scene.bounds.min, scene.bounds.max) / 2,
    turnAboutTouched: turnAbout === 'touched',
    surfaceAt,
    looksAroundFrom: (eye) => scene.seats.some((seat) => distance(seat.eye, eye) <= seat.radius),
    home: views.home,
  };
}

/**
 * Where a message of input leads; other messages restart drags. `gestures` take it.
 *
 * @param {Gestures} gestures
 * @param {*} message
 * @param {Camera} camera
 * @param {NavigationContext} context
 * @returns {Camera}
 */
export function movedBy(gestures, message, camera, context) {
  switch (message.type) {
    case 'wheel':
      return gestures.wheel(message, camera, context);
    case 'keydown':
      return gestures.keyDown(message, camera, context) ?? camera;
    case 'keyup':
      gestures.keyUp(message);
      return camera;
    case undefined:
      gestures.restart(camera);
      return camera;
    default:
      return gestures.pointer(message, camera, context);
  }
}
