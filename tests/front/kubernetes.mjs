// The manifests against the Kubernetes schemas: types by those of npm's kubernetes-models, unknown
// keys because every object here is closed (the API server drops them without a message). Then the
// relations between resources: names, probes, seconds that must fit.
import assert from 'node:assert/strict';
import {readFileSync, readdirSync} from 'node:fs';
import {createRequire} from 'node:module';
import {isIPv4} from 'node:net';
import {dirname, join} from 'node:path';
import {fileURLToPath} from 'node:url';
import {parseAllDocuments} from 'yaml';

const HERE = dirname(fileURLToPath(import.meta.url));
const MANIFESTS = join(HERE, '../../docker/kubernetes');
const require = createRequire(import.meta.url);
const OPERATOR = join(HERE, 'node_modules/@kubernetes-models/prometheus-operator/monitoring.coreos.com/v1');

// Schemas arrive as the package registers them, each referring to others by name. All of them are closed on their way in.
function close(schema) {
  if (Array.isArray(schema)) return schema.map(close);
  if (schema === null || typeof schema !== 'object') return schema;
  const out = Object.fromEntries(Object.entries(schema).map(([key, value]) => [key, close(value)]));
  if (out.properties && out.additionalProperties === undefined) out.additionalProperties = false;
  return out;
}
const {default: Ajv} = require('ajv');
const plain = Ajv.prototype.addSchema;
let operators;  // the validator of the operator's kinds, a package with a copy of its own
Ajv.prototype.addSchema = function (schema, id, meta, ...rest) {
  if (`${id}`.startsWith('monitoring.coreos.com')) operators = this;
  return plain.call(this, meta ? schema : close(schema), id, meta, ...rest);
};
const {ajv} = require(join(HERE, 'node_modules/@kubernetes-models/validate/dist/ajv.js'));

function schemaOf({apiVersion, kind}) {
  if (apiVersion === 'monitoring.coreos.com/v1') {
    try {
      new (require(join(OPERATOR, kind))[kind])({}).validate();  // which registers the schema
    } catch {}
    return `monitoring.coreos.com.v1.${kind}`;
  }
  const [group, version] = apiVersion.includes('/') ? apiVersion.split('/') : ['core', apiVersion];
  const words = [group.replace(/\..*/, ''), version, kind].map((w) => w[0].toUpperCase() + w.slice(1));
  require(join(HERE, `node_modules/kubernetes-models/_schemas/IoK8sApi${words.join('')}.js`)).addSchema();
  return `io.k8s.api.${group.replace(/\..*/, '')}.${version}.${kind}`;
}

// Kustomize's own files have no schema there: their keys.
const KUSTOMIZATION = ['apiVersion', 'kind', 'namespace', 'resources', 'secretGenerator', 'configMapGenerator', 'images', 'patches'];
const GENERATOR = ['name', 'type', 'files'];

export function faults(document) {
  if (document.kind === 'Kustomization') {
    return [...Object.keys(document).filter((key) => !KUSTOMIZATION.includes(key)),
      ...[...document.secretGenerator ?? [], ...document.configMapGenerator ?? []].flatMap(Object.keys).filter((key) => !GENERATOR.includes(key))];
  }
  const id = schemaOf(document);
  const validator = id.startsWith('monitoring') ? operators : ajv;
  if (validator.validate(id, document)) return [];
  return validator.errors.map((e) => `${e.instancePath} ${e.message} ${JSON.stringify(e.params)}`);
}

function documents(folder) {
  return readdirSync(folder, {recursive: false, withFileTypes: true}).flatMap((entry) => {
    const path = join(folder, entry.name);
    if (entry.isDirectory()) return documents(path);
    if (!entry.name.endsWith('.yaml')) return [];
    return parseAllDocuments(readFileSync(path, 'utf8')).map((d) => {
      assert.deepEqual(d.errors, [], path);
      return {path, document: d.toJS()};
    });
  });
}

// As Kustomize does it for the content of our patches: objects by key, lists of named things by
// name, new ones at their end.
function patched(base, patch) {
  if (Array.isArray(base)) {
    const added = patch.filter((p) => !base.some((item) => item.name === p.name));
    return [...base.map((item) => patched(item, patch.find((p) => p.name === item.name) ?? {})), ...added];
  }
  if (patch === null || typeof patch !== 'object') return patch;
  const merged = Object.entries(patch).map(([key, value]) => [key, base?.[key] === undefined ? value : patched(base[key], value)]);
  return {...base, ...Object.fromEntries(merged)};
}

const files = documents(MANIFESTS);
const patches = files.filter((f) => f.document.kind === 'Kustomization')
  .flatMap((f) => (f.document.patches ?? []).map((p) => join(dirname(f.path), p.path)));
const resource = ({kind, metadata}) => files.find((f) => f.document.kind === kind && f.document.metadata.name === metadata.name &&
  !patches.includes(f.path)).document;
const all = files.map((f) => (patches.includes(f.path) ? {...f, document: patched(resource(f.document), f.document)} : f));
assert.ok(all.length >= 8 && patches.length >= 1, `only ${all.length} manifests`);
for (const {path, document} of all) assert.deepEqual(faults(document), [], path);

const MONITORS = ['PodMonitor', 'PrometheusRule'];
const of = (kind, part = MONITORS.includes(kind) ? 'monitoring' : 'base') =>
  structuredClone(all.find((d) => d.document.kind === kind && d.path.includes(part)).document);

// This check can fail: a key misspelt anywhere, a number as text, a text as number, a member left out.
const spoilt = [
  ['Deployment', (d) => { d.spec.template.spec.containers[0].readynessProbe = {}; }],
  ['Deployment', (d) => { d.spec.template.spec.containers[0].resources.limit = {cpu: '1'}; }],
  ['Deployment', (d) => { d.spec.template.spec.terminationGracePeriodSecond = 30; }],
  ['Deployment', (d) => { d.spec.replicas = '3'; }],
  ['Deployment', (d) => { d.spec.template.spec.containers[0].env[1].value = 5; }],
  ['Deployment', (d) => { delete d.spec.selector; }],
  ['Deployment', (d) => { d.spec.template.spec.containers[0].securityContext.readOnlyRootFileSystem = true; }],
  ['HorizontalPodAutoscaler', (d) => { d.spec.behavior.scaleDown.stabilisationWindowSeconds = 1; }],
  ['PodDisruptionBudget', (d) => { d.spec.maxUnavailabel = 1; }],
  ['NetworkPolicy', (d) => { d.spec.ingress[0].from[0].nameSpaceSelector = {}; }],
  ['Service', (d) => { d.spec.ports[0].targetport = 'http'; }],
  ['Kustomization', (d) => { d.secretGenerators = []; }, 'overlays'],
  ['Kustomization', (d) => { d.secretGenerator[0].file = ['x']; }, 'overlays'],
  ['PodMonitor', (d) => { d.spec.joblabel = 'x'; }],
  ['PodMonitor', (d) => { d.spec.podMetricsEndpoints[0].relabelings[0].source_labels = ['x']; }],
  ['PodMonitor', (d) => { d.spec.podMetricsEndpoints[0].port = 9090; }],
  ['PodMonitor', (d) => { delete d.spec.selector; }],
  ['PrometheusRule', (d) => { d.spec.groups[1].rules[0].expression = 'up'; }],
];
for (const [kind, spoil, part] of spoilt) {
  const document = of(kind, part);
  assert.deepEqual(faults(document), []);
  spoil(document);
  assert.notDeepEqual(faults(document), [], `${kind}: ${spoil}`);
}

const {spec: deployment} = of('Deployment');
const pod = deployment.template.spec;
const [container] = pod.containers;
const env = Object.fromEntries(container.env.map((e) => [e.name, e.value]));
const ports = container.ports.map((p) => p.name);

// Requirements of "restricted" in the pod security standards.
assert.equal(pod.securityContext.runAsNonRoot, true);
assert.equal(pod.securityContext.seccompProfile.type, 'RuntimeDefault');
assert.equal(container.securityContext.allowPrivilegeEscalation, false);
assert.equal(container.securityContext.readOnlyRootFilesystem, true);
assert.deepEqual(container.securityContext.capabilities, {drop: ['ALL']});

// drain delay + accepted work (at least the budget of most endpoints, 2 s; longer jobs are 503 and begin again elsewhere) + 5 s before the kill; the delay longer than a readiness poll.
const BUDGET_S = 2;
assert.ok(Number(env.TUBECUT_DRAIN_S) >= BUDGET_S);
assert.ok(pod.terminationGracePeriodSeconds > Number(env.TUBECUT_DRAIN_DELAY_S) + Number(env.TUBECUT_DRAIN_S) + 5);
assert.ok(Number(env.TUBECUT_DRAIN_DELAY_S) > container.readinessProbe.periodSeconds);
assert.equal(pod.enableServiceLinks, false);

assert.deepEqual(container.startupProbe.exec.command, ['tubecut-server', 'selftest']);
for (const probe of ['readinessProbe', 'livenessProbe']) assert.ok(ports.includes(container[probe].httpGet.port), probe);

// Everything finds the pods by their labels, and one another by name.
const labels = deployment.template.metadata.labels;
const selected = [deployment.selector.matchLabels, of('Service').spec.selector, of('PodDisruptionBudget').spec.selector.matchLabels,
  of('NetworkPolicy').spec.podSelector.matchLabels, of('PodMonitor').spec.selector.matchLabels, ...pod.topologySpreadConstraints.map((c) => c.labelSelector.matchLabels)];
for (const selector of selected) assert.deepEqual(selector, labels);
assert.equal(of('HorizontalPodAutoscaler').spec.scaleTargetRef.name, of('Deployment').metadata.name);
assert.ok(ports.includes(of('Service').spec.ports[0].targetPort));
for (const {port} of of('PodMonitor').spec.podMetricsEndpoints) assert.ok(ports.includes(port));
for (const rule of of('NetworkPolicy').spec.ingress) for (const p of rule.ports) assert.ok(ports.includes(p.port));
assert.equal(of('Ingress', 'overlays').spec.rules[0].http.paths[0].backend.service.name, of('Service').metadata.name);

// Settings of a site in the example's patches. An address or network that the server accepts.
const site = all.filter((d) => d.path.includes('overlays') && d.document.kind === 'Deployment')
  .map((d) => d.document.spec.template.spec.containers[0]);
const trusted = site.flatMap((c) => c.env).filter((e) => e.name === 'TUBECUT_TRUSTED_PROXY');
assert.equal(trusted.length, 1);
const [address, bits] = trusted[0].value.split('/');
assert.ok(isIPv4(address) && Number(bits) <= 32);

// One command makes every required secret, under the file names that its users expect, from files
// that git ignores.
const kustomization = of('Kustomization', 'overlays');
const made = Object.fromEntries(kustomization.secretGenerator.map((s) => [s.name, s.files.map((f) => f.split('='))]));
const asked = [...pod.volumes.flatMap((v) => v.secret?.secretName ?? []), ...of('Ingress', 'overlays').spec.tls.map((t) => t.secretName)];
assert.deepEqual(Object.keys(made).sort(), asked.sort());
const keys = pod.volumes.find((v) => v.secret?.secretName === 'tubecut-keys');
const mount = container.volumeMounts.find((m) => m.name === keys.name).mountPath;
assert.deepEqual(made['tubecut-keys'].map(([name]) => `${mount}/${name}`), [env.TUBECUT_KEYS]);
assert.equal(kustomization.secretGenerator.find((s) => s.name === 'tubecut-tls').type, 'kubernetes.io/tls');
assert.deepEqual(made['tubecut-tls'].map(([name]) => name).sort(), ['tls.crt', 'tls.key']);
const ignored = readFileSync(join(HERE, '../../.gitignore'), 'utf8').split('\n');
assert.ok(ignored.includes('/docker/kubernetes/overlays/*/site/'));
const guide = readFileSync(join(HERE, '../../docs/operations.md'), 'utf8');
for (const file of Object.values(made).flat().map(([, path]) => path)) {
  assert.ok(file.startsWith('site/'), file);
  assert.ok(guide.includes(`$overlay/${file}`) , `the guide does not say where ${file} comes from`);
}
assert.ok(all.some((d) => d.document.kind === 'Namespace' && d.document.metadata.name === kustomization.namespace));
assert.equal(of('Kustomization', 'monitoring').namespace, kustomization.namespace);

// Checks without a key need no key: the admin port never does, the service's port does for all but
// the console, and a check of HAProxy's without a method is OPTIONS.
for (const probe of ['readinessProbe', 'livenessProbe']) assert.equal(container[probe].httpGet.port, 'admin', probe);
const {annotations} = of('Ingress', 'overlays').metadata;
assert.match(annotations['haproxy.org/check-http'] ?? 'HEAD /', /^(GET|HEAD) \/( |$)/);

// 70 % of the CPU that a replica may use, at any size; and spare replicas for a disruption.
const autoscaler = of('HorizontalPodAutoscaler').spec;
const cores = (text) => (text.endsWith('m') ? Number(text.slice(0, -1)) / 1000 : Number(text));
for (const {resources} of [container, ...site.filter((c) => c.resources.limits.cpu !== container.resources.limits.cpu)]) {
  const busy = (autoscaler.metrics[0].resource.target.averageUtilization / 100) * cores(resources.requests.cpu);
  assert.ok(Math.abs(busy / cores(resources.limits.cpu) - 0.7) < 1e-9, JSON.stringify(resources));
}
assert.equal(deployment.replicas, undefined);
assert.ok(autoscaler.minReplicas - of('PodDisruptionBudget').spec.maxUnavailable >= 2);
assert.ok(env.TUBECUT_KEYS.startsWith(container.volumeMounts[0].mountPath));
assert.equal(container.volumeMounts[0].name, pod.volumes[0].name);

// Every file of the folder is used, and there.
for (const {path, document} of all.filter((d) => d.document.kind === 'Kustomization')) {
  const named = [...document.resources, ...(document.patches ?? []).map((p) => p.path)].filter((n) => n.endsWith('.yaml')).sort();
  const there = readdirSync(dirname(path)).filter((n) => n.endsWith('.yaml') && n !== 'kustomization.yaml').sort();
  assert.deepEqual(named, there, path);
}
console.log(`${all.length} manifests, ${spoilt.length} spoilt ones refused`);
