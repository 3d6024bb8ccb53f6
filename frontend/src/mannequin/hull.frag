// Soft light from one side, the same for all pieces; edges that face away are darker.
uniform vec3 colour;
uniform vec3 light;
uniform float eye;
varying vec3 place;
varying vec3 away;
varying float bright;

void main() {
  vec3 facing = normalize(away);
  vec3 sight = eye > 0.0 ? normalize(vec3(0.0, 0.0, eye) - place) : vec3(0.0, 0.0, 1.0);
  float soft = 0.5 + 0.5 * dot(facing, light);
  float edge = clamp(dot(facing, sight), 0.0, 1.0);
  float shade = bright * (0.34 + 0.66 * soft * soft) * (0.8 + 0.2 * edge);
  gl_FragColor = vec4(shade * colour, 1.0);
}
