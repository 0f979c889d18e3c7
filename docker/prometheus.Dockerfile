# Prometheus of the same Debian, with this configuration: podman build --format docker -f docker/prometheus.Dockerfile -t tubecut-prometheus docker
ARG BASE=docker.io/library/debian:bookworm-slim
FROM ${BASE}
RUN apt-get update && apt-get upgrade -y && apt-get install -y --no-install-recommends prometheus \
 && rm -rf /var/lib/apt/lists/* /var/cache/apt/* /var/cache/ldconfig/* /var/cache/debconf/* /var/log/* \
 && install -d -o prometheus -g prometheus /prometheus
COPY prometheus.yml prometheus-rules.yml /etc/prometheus/
RUN ["promtool", "check", "config", "/etc/prometheus/prometheus.yml"]
USER prometheus
VOLUME /prometheus
EXPOSE 9090
ENTRYPOINT ["prometheus", "--config.file=/etc/prometheus/prometheus.yml", "--storage.tsdb.path=/prometheus", \
            "--storage.tsdb.retention.time=30d", "--web.listen-address=:9090"]
