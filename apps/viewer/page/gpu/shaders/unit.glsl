// Unit vectors as two numbers: the octahedral map.

vec2 packUnit(vec3 n) {
  n /= abs(n.x) + abs(n.y) + abs(n.z);
  vec2 turned = (1.0 - abs(n.yx)) * vec2(n.x < 0.0 ? -1.0 : 1.0, n.y < 0.0 ? -1.0 : 1.0);
  return n.z < 0.0 ? turned : n.xy;
}

vec3 unpackUnit(vec2 p) {
  vec3 n = vec3(p, 1.0 - abs(p.x) - abs(p.y));
  if (n.z < 0.0) n.xy = (1.0 - abs(n.yx)) * vec2(n.x < 0.0 ? -1.0 : 1.0, n.y < 0.0 ? -1.0 : 1.0);
  return normalize(n);
}
