// A corner of the hull of two balls. `position` has cosine and sine of the angle round the axis, and
// the number of the ball; `share` is the way over its cap from the pole to the rim, in sines of latitude.
attribute float share;
attribute vec4 one;
attribute vec4 other;
attribute float tone;
// The factor that moves corners outwards, so that the faces between them have the right mean width.
uniform float rounder;
varying vec3 place;
varying vec3 away;
varying float bright;

void main() {
  vec3 way = other.xyz - one.xyz;
  float apart = length(way);
  vec3 axis = apart > 1e-6 ? way / apart : vec3(0.0, 0.0, 1.0);
  // At the rim, the cone between the balls touches them.
  float rim = clamp((one.w - other.w) / max(apart, 1e-6), -1.0, 1.0);
  bool first = position.z < 0.5;
  float up = first ? mix(-1.0, rim, share) : mix(1.0, rim, share);
  vec3 side = normalize(cross(abs(axis.z) < 0.9 ? vec3(0.0, 0.0, 1.0) : vec3(1.0, 0.0, 0.0), axis));
  vec3 outwards = position.x * side + position.y * cross(axis, side);
  away = up * axis + sqrt(max(1.0 - up * up, 0.0)) * outwards;
  vec4 ball = first ? one : other;
  place = ball.xyz + rounder * ball.w * away;
  bright = tone;
  gl_Position = projectionMatrix * viewMatrix * vec4(place, 1.0);
}
