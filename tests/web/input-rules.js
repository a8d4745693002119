/** What the server says of input in `welcome`: the unit tests use it, and the contract holds the server to it. */
export const INPUT_RULES = {
  wheelSteps: [100, 3, 1 / 3],
  wheelZoom: 1.1,
  dragZoom: 4,
  drags: { vrut: { 1: 'rotate', 2: 'pan', 4: 'zoom' } },
  keys: ['ArrowLeft', 'ArrowRight', 'ArrowUp', 'ArrowDown', '+', '-', 'f', 'Home', 'w', 's', 'Escape', '1', '2', '3'],
  repeatingKeys: ['ArrowLeft', 'ArrowRight', 'ArrowUp', 'ArrowDown', '+', '-'],
};
