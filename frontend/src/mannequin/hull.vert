// A corner of the hull of two balls: `position` has which ball, how far over its cap from the pole
// (first) or the rim (second), and the angle round the axis.
attribute vec4 one;
attribute vec4 other;
attribute float tone;
varying vec3 place;
varying vec3 away;
varying float bright;

void main() {
  vec3 way = other.xyz - one.xyz;
  float apart = length(way);
  vec3 axis = apart > 1e-6 ? way / apart : vec3(0.0, 0.0, 1.0);
  // The rim is where the cone between the balls touches both: at this angle from the equator.
  float rim = asin(clamp((one.w - other.w) / max(apart, 1e-6), -1.0, 1.0));
  float pole = 1.5707963268;
  float latitude = position.x < 0.5 ? mix(-pole, rim, position.y) : mix(rim, pole, position.y);
  vec3 side = normalize(cross(abs(axis.z) < 0.9 ? vec3(0.0, 0.0, 1.0) : vec3(1.0, 0.0, 0.0), axis));
  vec3 ahead = cross(axis, side);
  away = sin(latitude) * axis + cos(latitude) * (cos(position.z) * side + sin(position.z) * ahead);
  vec4 ball = position.x < 0.5 ? one : other;
  place = ball.xyz + ball.w * away;
  bright = tone;
  gl_Position = projectionMatrix * viewMatrix * vec4(place, 1.0);
}
