{% if part == "signals" %}
    -- The host: an SPI master, mode 0, which belongs to no clock.
    constant SCK_HALF : time := {{ sck_half_cycles }} * CYCLE;
    signal spi_sck, spi_mosi : std_logic := '0';
    signal spi_cs_n : std_logic := '1';
    signal spi_miso, spi_miso_oe : std_logic;
{% elif part == "procedures" %}
        variable spi_sum : std_logic_vector(15 downto 0); -- CRC-16/CCITT-FALSE of the bytes of a frame

        procedure exchange (byte : std_logic_vector(7 downto 0); got : out std_logic_vector(7 downto 0)) is
        begin
            for n in 7 downto 0 loop
                spi_mosi <= byte(n);
                wait for SCK_HALF;
                got(n) := spi_miso;
                spi_sck <= '1';
                wait for SCK_HALF;
                spi_sck <= '0';
            end loop;
        end procedure;

        procedure add (byte : std_logic_vector(7 downto 0)) is
        begin
            for n in 7 downto 0 loop
                if (spi_sum(15) xor byte(n)) = '1' then
                    spi_sum := (spi_sum(14 downto 0) & '0') xor x"1021";
                else
                    spi_sum := spi_sum(14 downto 0) & '0';
                end if;
            end loop;
        end procedure;

        procedure send (bytes : std_logic_vector) is
            alias bits : std_logic_vector(bytes'length - 1 downto 0) is bytes;
            variable got : std_logic_vector(7 downto 0);
        begin
            for number in bits'length / 8 - 1 downto 0 loop
                exchange(bits(8 * number + 7 downto 8 * number), got);
                add(bits(8 * number + 7 downto 8 * number));
            end loop;
        end procedure;

        procedure begin_frame (command : std_logic_vector(7 downto 0); address : natural; count : positive) is
            variable got : std_logic_vector(7 downto 0);
        begin
            spi_cs_n <= '0';
            wait for SCK_HALF;
            check("spi_miso_oe when selected", spi_miso_oe, '1');
            spi_sum := x"FFFF";
            exchange(command, got);
            add(command);
            check("status byte", got, x"A0");
            send(bits_of(address, 16) & bits_of(count, 8));
        end procedure;

        procedure end_frame is
        begin
            wait for SCK_HALF;
            spi_cs_n <= '1';
            wait for SCK_HALF;
            check("spi_miso_oe when not selected", spi_miso_oe, '0');
        end procedure;

        procedure write_word (address : natural; value : word_t) is
            variable sum : std_logic_vector(15 downto 0);
        begin
            begin_frame(x"02", address, 1);
            send(value);
            sum := spi_sum;
            send(sum);
            end_frame;
            wait for SETTLE;
        end procedure;

        procedure read_words (address : natural; count : positive) is
            variable got : std_logic_vector(7 downto 0);
        begin
            begin_frame(x"03", address, count);
            exchange(x"00", got);
            for n in 0 to count - 1 loop
                for byte in 3 downto 0 loop
                    exchange(x"00", got);
                    add(got);
                    words(n)(8 * byte + 7 downto 8 * byte) := got;
                end loop;
            end loop;
            exchange(x"00", got);
            check("check sum, high byte", got, spi_sum(15 downto 8));
            exchange(x"00", got);
            check("check sum, low byte", got, spi_sum(7 downto 0));
            end_frame;
        end procedure;
{% endif %}
