# HAProxy of the same Debian, with this configuration: podman build --format docker -f docker/haproxy.Dockerfile -t tubecut-haproxy docker
ARG BASE=docker.io/library/debian:bookworm-slim
FROM ${BASE}
RUN apt-get update && apt-get upgrade -y && apt-get install -y --no-install-recommends haproxy \
 && rm -rf /var/lib/apt/lists/* /var/cache/apt/* /var/cache/ldconfig/* /var/cache/debconf/* /var/log/*
COPY haproxy.cfg rates.map /etc/haproxy/
COPY proxy /usr/local/bin/tubecut-proxy
COPY errors/*.http errors/*.json /etc/haproxy/errors/tubecut/
USER haproxy
EXPOSE 8443
# Soft stop: no new connections, what was begun is answered.
STOPSIGNAL SIGUSR1
ENTRYPOINT ["tubecut-proxy", "-f", "/etc/haproxy/haproxy.cfg"]
