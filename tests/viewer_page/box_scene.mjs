/** Makes a scene of solid boxes with exact rays, as the navigator sees it. */
export function boxScene(boxes, { bounds, home, voxelSize }) {
  const enter = (box, origin, direction) => {
    let near = 0, far = Infinity;
    for (let axis = 0; axis < 3; ++axis) {
      if (direction[axis] === 0) {
        if (origin[axis] < box.low[axis] || origin[axis] > box.high[axis]) return Infinity;
        continue;
      }
      const a = (box.low[axis] - origin[axis]) / direction[axis], b = (box.high[axis] - origin[axis]) / direction[axis];
      near = Math.max(near, Math.min(a, b));
      far = Math.min(far, Math.max(a, b));
    }
    return near <= far ? near : Infinity;
  };
  return {
    bounds, home, voxelSize, boxes,
    cast(origin, direction, most) {
      const distance = Math.min(...boxes.map((box) => enter(box, origin, direction)), Infinity);
      if (!(distance <= most)) return null;
      const position = origin.map((x, i) => x + direction[i] * distance);
      const voxel = position.map((x, i) => Math.floor((x - bounds.low[i]) / voxelSize));
      return { voxel, level: 10, face: 0, position, distance };
    },
  };
}

/** A room of `scale` metres' size with a step, a wall and a low ceiling: y is up. */
export function room(scale = 1) {
  const box = (low, high) => ({ low: low.map((x) => x * scale), high: high.map((x) => x * scale) });
  return boxScene(
    [
      box([-20, -1, -20], [20, 0, 20]),  // ground
      box([-20, 0, -10], [20, 12, -9]),  // wall
      box([4, 0, -20], [20, 0.3, 20]),   // a step
      box([10, 0, -20], [20, 2, 20]),    // too high to climb
    ],
    {
      bounds: box([-20, -1, -20], [20, 20, 20]),
      home: { eye: [0, 2 * scale, 8 * scale], target: [0, 1.5 * scale, 0], up: [0, 1, 0], fov: 50 },
      voxelSize: 0.02 * scale,
    });
}
