// The service under test: started on free ports, called over a few kept-alive connections, stopped.
import {spawn} from 'node:child_process';
import http from 'node:http';
import {createInterface} from 'node:readline';
import {setTimeout} from 'node:timers/promises';

const CONNECTIONS = 4;
const SECONDS = 60;  // to an answer: hung, not slow
const PATIENCE = 20;  // times

// A service refuses to start if a TUBECUT_ variable names none of its options, as those of the tests.
const withoutOptions = (all) => Object.fromEntries(Object.entries(all).filter(([name]) => !name.startsWith('TUBECUT_')));

export class Service {
  static async start(binary, ...options) {
    const child = spawn(binary, ['--host', '127.0.0.1', '--port', '0', '--admin-port', '0', '--budget-s', '30', ...options],  // the contract of answers, not of their speed
      {stdio: ['ignore', 'pipe', 'inherit'], env: withoutOptions(process.env)});
    const lines = createInterface({input: child.stdout});
    const first = await new Promise((resolve, reject) => {
      lines.once('line', resolve);
      child.once('error', reject);
      child.once('exit', (code) => reject(new Error(`the service ended with ${code}`)));
    });
    const ready = JSON.parse(first);
    if (ready.event !== 'ready') throw new Error(`not a ready line: ${first}`);
    return new Service(child, ready);
  }

  constructor(child, ready) {
    this.child = child;
    const kill = () => child.kill('SIGKILL');
    process.once('exit', kill);  // also when the test itself fails
    child.once('exit', () => process.removeListener('exit', kill));
    this.port = ready.port;
    this.agent = new http.Agent({keepAlive: true, maxSockets: CONNECTIONS});
    this.asked = 0;
  }

  get alive() {
    return this.child.exitCode === null && this.child.signalCode === null;
  }

  // {status, headers, body: Buffer, text}. If other requests with long budgets are ahead of it, the
  // answer is 429 or 503, and this repeats the request.
  async ask(path, options = {}) {
    for (let again = 0; ; again += 1) {
      const reply = await this.askOnce(path, options);
      if (reply.status !== 429 || again === PATIENCE) return reply;
      await setTimeout(1000);
    }
  }

  askOnce(path, {method = 'POST', body, headers = {}} = {}) {
    this.asked += 1;
    const bytes = body === undefined ? undefined : Buffer.from(body);
    const length = bytes === undefined ? {} : {'Content-Length': bytes.length};
    return new Promise((resolve) => {
      // No answer is one more bad answer: the test goes on and names the request.
      const fail = (error) => resolve({status: 599, headers: {}, body: Buffer.alloc(0), text: error.message});
      const call = http.request({
        host: '127.0.0.1', port: this.port, path, method, agent: this.agent,
        headers: {...(bytes ? {'Content-Type': 'application/json'} : {}), ...length, ...headers},
      }, (reply) => {
        const parts = [];
        reply.on('data', (part) => parts.push(part));
        reply.on('error', fail);
        reply.on('end', () => {
          const all = Buffer.concat(parts);
          resolve({status: reply.statusCode, headers: reply.headers, body: all, text: all.toString('utf8')});
        });
      });
      call.setTimeout(1000 * SECONDS, () => call.destroy(new Error(`no answer to ${method} ${path} in ${SECONDS} s`)));
      call.on('error', fail);
      if (bytes) call.write(bytes);
      call.end();
    });
  }

  post(path, value, options = {}) {
    return this.ask(path, {...options, body: JSON.stringify(value)});
  }

  async stop() {
    this.agent.destroy();
    if (!this.alive) return this.child.exitCode;
    const ended = new Promise((resolve) => this.child.once('exit', resolve));
    this.child.kill('SIGTERM');
    return ended;
  }
}

// Runs `task` on every item, a few at a time. Returns their number.
export async function each(items, task) {
  const queue = items[Symbol.iterator]();
  let taken = 0;
  const worker = async () => {
    for (let next = queue.next(); !next.done; next = queue.next()) {
      taken += 1;
      await task(next.value, taken - 1);
    }
  };
  await Promise.all(Array.from({length: CONNECTIONS}, worker));
  return taken;
}
