"""Games on a server. The file client.py needs the standard library only, and can be copied into other projects."""
