    // Host: an SPI master, mode 0, which belongs to no clock.
    localparam real SCK_HALF_NS = {{ sck_half_ns }};
    reg spi_sck, spi_cs_n, spi_mosi;
    wire spi_miso, spi_miso_oe;
    reg [7:0] spi_byte;
    reg [15:0] crc_sum;
    reg [7:0] want_status;
    reg [31:0] words_in [0:255];

    task host_idle;
        begin
            spi_sck = 1'b0;
            spi_cs_n = 1'b1;
            spi_mosi = 1'b0;
            want_status = 8'hA0;
        end
    endtask

    // CRC-16/CCITT-FALSE.
    task add_to_crc(input [7:0] value);
        integer k;
        for (k = 7; k >= 0; k = k - 1)
            crc_sum = {crc_sum[14:0], 1'b0} ^ (crc_sum[15] ^ value[k] ? 16'h1021 : 16'h0000);
    endtask

    task exchange_byte(input [7:0] value);
        integer k;
        for (k = 7; k >= 0; k = k - 1) begin
            spi_mosi = value[k];
            #(SCK_HALF_NS);
            spi_byte = {spi_byte[6:0], spi_miso};
            spi_sck = 1'b1;
            #(SCK_HALF_NS);
            spi_sck = 1'b0;
        end
    endtask

    task send_byte(input [7:0] value);
        begin
            exchange_byte(value);
            add_to_crc(value);
        end
    endtask

    task receive_byte;
        begin
            exchange_byte(8'h00);
            add_to_crc(spi_byte);
        end
    endtask

    task begin_frame(input [7:0] command, input [31:0] address, input integer words);
        begin
            spi_cs_n = 1'b0;
            #(SCK_HALF_NS);
            check("spi_miso_oe when selected", {47'd0, spi_miso_oe}, 48'd1);
            crc_sum = 16'hFFFF;
            send_byte(command);
            check("status byte", {40'd0, spi_byte}, {40'd0, want_status});
            send_byte(address[15:8]);
            send_byte(address[7:0]);
            send_byte(words[7:0]);
        end
    endtask

    task end_frame;
        begin
            #(SCK_HALF_NS);
            spi_cs_n = 1'b1;
            #(SCK_HALF_NS);
            check("spi_miso_oe when not selected", {47'd0, spi_miso_oe}, 48'd0);
        end
    endtask

    task bus_write;
        begin
            begin_frame(8'h02, access_address, 1);
            send_byte(access_value[31:24]);
            send_byte(access_value[23:16]);
            send_byte(access_value[15:8]);
            send_byte(access_value[7:0]);
            // The sum is not part of itself.
            exchange_byte(crc_sum[15:8]);
            exchange_byte(crc_sum[7:0]);
            end_frame;
            #(SETTLE_NS);
        end
    endtask

    task bus_read;
        integer n, k;
        begin
            begin_frame(8'h03, access_address, access_words);
            exchange_byte(8'h00);
            for (n = 0; n < access_words; n = n + 1)
                for (k = 0; k < 4; k = k + 1) begin
                    receive_byte;
                    words_in[n] = {words_in[n][23:0], spi_byte};
                end
            exchange_byte(8'h00);
            check("check sum, high byte", {40'd0, spi_byte}, {40'd0, crc_sum[15:8]});
            exchange_byte(8'h00);
            check("check sum, low byte", {40'd0, spi_byte}, {40'd0, crc_sum[7:0]});
            end_frame;
        end
    endtask

    function [31:0] word(input integer index);
        word = words_in[index];
    endfunction

    // A word of a write, and the sum behind it.
    task send_word(input [31:0] value, input [15:0] spoilt);
        begin
            send_byte(value[31:24]);
            #(7.0 * SCK_HALF_NS);
            send_byte(value[23:16]);
            send_byte(value[15:8]);
            send_byte(value[7:0]);
            crc_sum = crc_sum ^ spoilt;
            exchange_byte(crc_sum[15:8]);
            exchange_byte(crc_sum[7:0]);
            crc_sum = 16'hFFFF;
        end
    endtask

    task check_scratch(input [8*40-1:0] what, input [31:0] value);
        begin
            read_words(CARD_CONFIG_HOLD, 1);
            check(what, word(0), value);
        end
    endtask

    // Writes of several words, pauses, frames that are left, wrong check sums, frames to nobody; at the words of the card's configuration.
    task bus_limits;
        begin
            begin_frame(8'h02, CARD_CONFIG_TRIGGER_PERIOD, 2);
            #(SETTLE_NS);
            send_word(32'h00345678, 16'd0);
            #(SETTLE_NS);
            send_word(32'hA1B2C300, 16'd0);
            end_frame;
            #(SETTLE_NS);
            check_scratch("second word of a write", 32'hA1B2C300);
            read_words(CARD_CONFIG_TRIGGER_PERIOD, 1);
            check("first word of a write", word(0), 32'h00345678);
            // A frame that ends before its check sum writes nothing.
            begin_frame(8'h02, CARD_CONFIG_HOLD, 1);
            send_byte(8'hFF);
            send_byte(8'hFF);
            send_byte(8'hFF);
            send_byte(8'h00);
            end_frame;
            #(SETTLE_NS);
            check_scratch("word after a frame that was left", 32'hA1B2C300);
            // Neither does one with a wrong sum, whichever half is wrong; nor what is no command.
            begin_frame(8'h02, CARD_CONFIG_HOLD, 1);
            send_word(32'hFFFFFF00, 16'h0100);
            end_frame;
            #(SETTLE_NS);
            want_status = 8'hA2;
            check_scratch("word after a wrong check sum", 32'hA1B2C300);
            begin_frame(8'h02, CARD_CONFIG_HOLD, 1);
            send_word(32'hFFFFFF00, 16'h0001);
            end_frame;
            #(SETTLE_NS);
            check_scratch("word after a wrong check sum, low half", 32'hA1B2C300);
            begin_frame(8'h06, CARD_CONFIG_HOLD, 1);
            send_word(32'hFFFFFF00, 16'd0);
            end_frame;
            #(SETTLE_NS);
            check_scratch("word after a frame to nobody", 32'hA1B2C300);
            begin_frame(8'h02, CARD_CONFIG_HOLD, 1);
            send_word(32'd0, 16'd0);
            end_frame;
            #(SETTLE_NS);
            want_status = 8'hA0;
            check_scratch("word after a right check sum", 32'd0);
        end
    endtask
