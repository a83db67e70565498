"""Adapters of the outside services behind the core's ports: plain httpx, journalled, paced, accounted for."""
